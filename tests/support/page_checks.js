/* What a page lacks: contrast of words (WCAG 2 AA), text alternatives, names of controls, width. Returns a list of sentences. */
(() => {
  const found = [];
  const parts = tone => (/rgba?\(([^)]*)\)/.exec(tone)?.[1] ?? "0,0,0,0").split(/[ ,/]+/).map(Number);
  const over = (top, low) => { const a = top[3] ?? 1; return [0, 1, 2].map(k => top[k] * a + low[k] * (1 - a)); };
  const luminance = tone => tone.slice(0, 3).map(x => x / 255).map(x => x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4)
    .reduce((sum, x, k) => sum + x * [0.2126, 0.7152, 0.0722][k], 0);
  const behind = element => {
    const layers = [];
    for (let each = element; each; each = each.parentElement) {
      const tone = parts(getComputedStyle(each).backgroundColor);
      if ((tone[3] ?? 1) > 0) layers.push(tone);
      if ((tone[3] ?? 1) === 1) break;
    }
    return layers.reverse().reduce((low, top) => over(top, low), matchMedia("(prefers-color-scheme: dark)").matches ? [0, 0, 0] : [255, 255, 255]);
  };
  const words = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT), seen = new Set();
  while (words.nextNode()) {
    const element = words.currentNode.parentElement;
    if (!words.currentNode.data.trim() || seen.has(element) || !element.checkVisibility({checkOpacity: true, checkVisibilityCSS: true})) continue;
    seen.add(element);
    if (element.closest("script, style, noscript, .visually-hidden, [aria-hidden=true], [disabled]")) continue;
    const box = element.getBoundingClientRect(), style = getComputedStyle(element);
    if (box.width < 2 || box.height < 2) continue;
    const low = behind(element), [a, b] = [luminance(over(parts(style.color), low)), luminance(low)].sort((x, y) => y - x);
    const large = parseFloat(style.fontSize) >= 24 || (parseFloat(style.fontSize) >= 18.66 && +style.fontWeight >= 700);
    const ratio = (a + 0.05) / (b + 0.05);
    if (ratio < (large ? 3 : 4.5) - 0.01)
      found.push(`contrast ${ratio.toFixed(2)} of "${words.currentNode.data.trim().slice(0, 30)}" (${element.tagName} ${element.className})`);
  }
  for (const each of document.querySelectorAll("img")) if (!each.hasAttribute("alt")) found.push("no text alternative: " + each.src.slice(0, 60));
  for (const each of document.querySelectorAll("iframe")) if (!each.hasAttribute("title")) found.push("a frame without a title");
  for (const each of document.querySelectorAll("a[href], button, input, select")) {
    const name = each.ariaLabel || each.textContent.trim() || each.title || each.placeholder || each.querySelector("img")?.alt || (each.labels?.length ?? 0);
    if (!name && each.checkVisibility()) found.push(`no name: ${each.outerHTML.slice(0, 80)}`);
  }
  if (document.documentElement.scrollWidth > innerWidth + 1) found.push(`${document.documentElement.scrollWidth - innerWidth} points too wide`);
  if (!document.documentElement.lang) found.push("no language");
  if (document.querySelectorAll("h1").length !== 1) found.push(`${document.querySelectorAll("h1").length} headings of the first level`);
  return found;
})()

/* Graphs over time, with ticks, a zero line, units and a cursor, for films, live views and the drawing board. `picture` has the colours; lines are
 * {name, unit, values}, at `times`, or equally spaced from `from` to `to`. What rests is drawn once for each `key`. */
const HUES = ["accent", "second", "third", "ink", "grey", "force"], FONT = "11px system-ui, sans-serif";
const shortly = x => x === 0 ? "0" : Math.abs(x) >= 1e4 || Math.abs(x) < 1e-2 ? x.toExponential(2) : x.toPrecision(3);
const tickOf = x => x === 0 ? "0" : Math.abs(x) >= 1e4 || Math.abs(x) < 1e-3 ? x.toExponential().replace("e+", "e") : String(+x.toPrecision(6));
const ticksOf = (low, high, most) => {
  const rough = (high - low) / most, power = 10 ** Math.floor(Math.log10(rough)), step = power * ([1, 2, 5].find(each => each * power >= rough * 0.999) ?? 10);
  const first = Math.ceil(low / step - 1e-9), count = Math.floor(high / step + 1e-9) - first + 1;
  if (count < 2 && most < 20) return ticksOf(low, high, most + 1);      // one tick has no scale
  return Array.from({length: Math.max(count, 0)}, (_, i) => +((first + i) * step).toPrecision(12));
};
const logOf = x => x ? Math.log10(Math.abs(x)) : NaN;
const rangeOf = (lines, log) => {
  const known = lines.flatMap(each => Array.from(each.values, x => log ? logOf(x) : x).filter(Number.isFinite));
  let low = known.reduce((a, b) => Math.min(a, b), Infinity), high = known.reduce((a, b) => Math.max(a, b), -Infinity);
  if (!known.length) [low, high] = [0, 1];
  if (log) return [Math.floor(low), Math.max(Math.ceil(high), Math.floor(low) + 1)];
  const largest = Math.max(Math.abs(low), Math.abs(high)), isConstant = high - low < 1e-6 * largest || !largest;       // rounding is not drawn
  const room = isConstant ? 0.5 * largest || 1 : 0.05 * (high - low);
  return [low - room, high + room];
};
const graph = (element, {tones, fit}, lines, {from, to, times = null, now = null, log = false, key = null}) => {
  const brush = element.getContext("2d"), [w, h] = fit(element, brush);
  if (!element.width || !element.height) return;
  const known = [key, element.width, element.height, tones.ink].join();
  if (key === null || element.known !== known) {
    element.known = known;
    element.drawn = restingGraph(brush, lines, {tones, w, h, from, to, times, log});
  }
  const {still, area: [left, right, top, low], words, size} = element.drawn;
  brush.clearRect(0, 0, w, h);
  brush.drawImage(still, 0, 0, w, h);
  brush.font = FONT;
  lines.forEach((line, i) => {
    const value = log ? Math.max(...Array.from(line.values, Math.abs).filter(Number.isFinite), 0)
      : line.values[Math.round((now === null ? 1 : (now - from) / (to - from || 1)) * (line.values.length - 1))];
    brush.fillStyle = tones[HUES[i % 6]];
    brush.fillText(line.name + " " + (log ? "\u2264 " : "") + (Number.isFinite(value) ? shortly(Math.abs(value) < size ? 0 : value) + " " + line.unit : ""), ...words[i], right - words[i][0]);
  });
  if (now === null) return;
  const x = left + (right - left) * (now - from) / (to - from || 1);
  Object.assign(brush, {strokeStyle: tones.ink, lineWidth: 1});
  brush.beginPath();
  brush.moveTo(x, top);
  brush.lineTo(x, low);
  brush.stroke();
};
const restingGraph = (brush, lines, {tones, w, h, from, to, times, log}) => {
  const still = document.createElement("canvas"), pen = still.getContext("2d"), [a, b] = rangeOf(lines, log);
  [still.width, still.height] = [brush.canvas.width, brush.canvas.height];
  pen.setTransform(brush.getTransform());
  Object.assign(pen, {font: FONT, lineWidth: 1, fillStyle: tones.grey});
  const words = [];           // places of names, in rows
  let [x, y] = [4, 11];
  for (const {name, unit} of lines) {
    const wide = pen.measureText(`${name} \u2264 -0.00e-00 ${unit}`).width + 10;
    if (x > 4 && x + wide > w) [x, y] = [4, y + 14];
    words.push([x, y]);
    x += wide;
  }
  const top = y + 7, low = h - 16, right = w - 8, heights = low - top > 20 ? ticksOf(a, b, Math.max(2, Math.floor((low - top) / 26))) : [];
  const marks = heights.filter(each => !log || Number.isInteger(each)).map(each => [each, log ? `1e${each}` : tickOf(each)]);
  const left = 8 + Math.max(12, ...marks.map(([, text]) => pen.measureText(text).width)), up = each => low - (low - top) * (each - a) / (b - a);
  const line = (points, tone, wide) => {
    pen.beginPath();
    points.forEach(([x, y], i) => pen[i ? "lineTo" : "moveTo"](x, y));
    Object.assign(pen, {strokeStyle: tone, lineWidth: wide});
    pen.stroke();
  };
  for (const [each, text] of marks) {
    line([[left, up(each)], [right, up(each)]], tones[each === 0 && !log ? "grey" : "body"], each === 0 && !log ? 1.2 : 0.6);
    pen.fillText(text, left - 4 - pen.measureText(text).width, up(each) + 4);
  }
  for (const each of ticksOf(from, to || 1, Math.max(1, Math.floor((right - left) / 60)))) {
    const at = left + (right - left) * (each - from) / (to - from || 1), text = tickOf(each), wide = pen.measureText(text).width;
    line([[at, low], [at, low + 4]], tones.grey, 1);
    pen.fillText(text, Math.min(Math.max(at - wide / 2, 2), right - wide - 12), h - 3);
  }
  pen.fillText("s", right - 5, h - 3);
  line([[left, top], [left, low], [right, low]], tones.grey, 1);
  lines.forEach(({values}, i) => {
    const share = k => times ? (times[k] - from) / (to - from || 1) : k / Math.max(values.length - 1, 1);
    const points = Array.from(values, (x, k) => [left + (right - left) * share(k), up(log ? logOf(x) : x)]);
    for (let k = 0; k < points.length; k++) {      // the parts between what is no number
      const part = [];
      while (k < points.length && Number.isFinite(points[k][1])) part.push(points[k++]);
      line(part, tones[HUES[i % 6]], 1.5);
    }
  });
  return {still, area: [left, right, top, low], words, size: log ? 0 : 1e-9 * Math.max(b, -a)};      // below it is rounding
};

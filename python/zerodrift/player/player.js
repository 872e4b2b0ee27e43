(() => {
const film = JSON.parse(document.getElementById("scene").textContent);
const space = film.dimension === 3, last = film.samples - 1;
const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
let now = 0, playing = last > 0 && !still, before = 0, rate = 1, dirty = true;

/* ---- numbers ---- */

const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
const levels = (each, text) => Array.from(new Uint16Array(bytes(text)), x => each.least + each.size * x / 65535);
for (const layer of film.layers) {
  layer.table = new Uint16Array(bytes(layer.points));
  layer.paths = layer.paths.map(path => {
    const d = film.dimension, table = new Uint16Array(bytes(path.points));
    return Array.from({length: table.length / d}, (_, i) => path.low.map((x, k) => x + path.size[k] * table[i * d + k] / 65535));
  });
  for (const load of layer.loads) load.values = levels(load, load.values);
}
for (const line of [...film.graphs, ...film.trust]) {
  line.values = new Float32Array(bytes(line.values));
  if (film.layers.length > 1) line.name = line.label + " " + line.name;
}

const shown = () => film.nearest ? Math.round(now) : now;       // where cubics through samples would change the shapes, samples alone
const sharesOf = s => [-s * (s - 1) * (s - 2) / 6, (s + 1) * (s - 1) * (s - 2) / 2, -(s + 1) * s * (s - 2) / 2, (s + 1) * s * (s - 1) / 6];
const locate = layer => {       // points on cubics through four samples, then those that bodies carry
  const d = film.dimension, low = film.box[0], step = film.box[1].map((x, k) => (x - low[k]) / 65535), {table} = layer, vectors = layer.moving - layer.vectors;
  const first = Math.min(Math.max(Math.floor(shown()) - 1, 0), Math.max(last - 3, 0)), shares = last < 3 ? [1] : sharesOf(shown() - first - 1);
  layer.at = Array.from({length: layer.moving}, (_, n) => Array.from({length: d}, (_, k) => {
    const level = shares.reduce((sum, share, i) => sum + share * table[((first + i) * layer.moving + n) * d + k], 0);
    return n < vectors ? low[k] + step[k] * level : 2 * level / 65535 - 1;       // vectors of arrows have a box of their own
  }));
  for (const [base, own] of layer.carried) {
    const [a, b, c] = base.map(n => place(layer, n)), along = sub(b, a);
    if (!space) { layer.at.push([a[0] + own[0] * along[0] - own[1] * along[1], a[1] + own[0] * along[1] + own[1] * along[0]]); continue; }
    const aside = sub(c, a), normal = cross(along, aside), far = length(along) || 1;
    layer.at.push(a.map((x, k) => x + own[0] * along[k] + own[1] * aside[k] + own[2] * normal[k] / far));
  }
};

/* ---- page ---- */

const make = (tag, parent, attributes = {}) => {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return parent.appendChild(element);
};
const stage = make("div", document.body, {class: "stage"});
const canvas = make("canvas", stage, {role: "img", tabindex: "0", "aria-label": "Film of " + film.name + "; arrow keys step, n chooses the next part" + (space ? ", Shift with arrow keys turns" : "")});
const units = [...new Set(film.graphs.map(line => line.unit))];
const panels = units.length ? make("div", stage, {class: "graphs"}) : null;
const graphs = units.map(unitOf => ({unit: unitOf, lines: film.graphs.filter(line => line.unit === unitOf),
  canvas: make("canvas", panels, {role: "img", "aria-label": "Graphs of " + film.graphs.filter(line => line.unit === unitOf).map(line => line.name).join(", ")})}));
const controls = make("div", document.body, {class: "controls"});
const button = make("button", controls, {type: "button"});
const slider = make("input", controls, {type: "range", min: 0, max: Math.max(last, 1), step: "any", value: 0, "aria-label": "Time"});
const clock = make("output", controls);
const speeds = make("select", controls, {"aria-label": "Speed of the film"});
for (const each of [0.1, 0.25, 0.5, 1, 2, 4]) make("option", speeds, {value: each}).textContent = each + " x";
speeds.value = 1;
const file = (name, blob) => {
  const link = document.createElement("a");
  Object.assign(link, {href: URL.createObjectURL(blob), download: `${film.name}.${name}`});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
};
const table = () => {           // what is graphed, one line for each time
  const all = [...film.graphs, ...film.trust], count = all[0].values.length, quoted = text => `"${text.replaceAll('"', '""')}"`;
  const rows = Array.from({length: count}, (_, i) => [film.span[0] + (film.span[1] - film.span[0]) * i / Math.max(count - 1, 1), ...all.map(each => each.values[i])].join());
  return [["t [s]", ...all.map(each => `${each.name} [${each.unit}]`)].map(quoted).join(), ...rows, ""].join("\n");
};
const acts = {"Full screen": () => document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen().catch(() => 0),
  "Picture": () => canvas.toBlob(blob => file("png", blob)), ...film.graphs.length + film.trust.length ? {"Table": () => file("csv", new Blob([table()], {type: "text/csv"}))} : {}};
const more = make("select", controls, {"aria-label": "More"});
for (const name of ["More", ...Object.keys(acts)]) make("option", more).textContent = name;
more.addEventListener("change", () => { acts[more.value]?.(); more.selectedIndex = 0; });
const trust = film.trust.length ? make("canvas", make("div", document.body, {class: "trust"}), {role: "img", "aria-label": "Position violation and energy error over time"}) : null;
const note = make("div", document.body, {class: "note", "aria-live": "polite"});
const thinned = note.textContent = film.thinned ? `${film.samples} samples of the motion are shown.` : "";
const picture = pictureOf(film, canvas, () => { dirty = true; });
const {view, tones, place, turnBy, zoomBy, sub, cross, length, project} = picture;

/* ---- a picture ---- */

const draw = () => {
  film.layers.forEach(locate);
  picture.draw(view.chosen && told());
  const [from, to] = film.span, how = {from, to, now: seconds(), key: "film"};
  if (trust) graph(trust, picture, film.trust, {...how, log: true});
  graphs.forEach(each => graph(each.canvas, picture, each.lines, how));
  if (view.chosen && (!playing || now < said || now > said + film.samples / 10)) [said, note.textContent] = [now, told()];
};
let said = 0;               // time of the line for screen readers, which follows a motion in tenths
const told = () => {        // the chosen part, and its forces in each of the films
  const loads = film.layers.flatMap(layer => layer.loads.filter(each => each.name === view.chosen).map(each => shortly(at(each.values)) + " " + each.unit));
  const arrows = loads.length ? [] : film.layers.flatMap(layer => layer.arrows.filter(each => each.name === view.chosen).map(each => shortly(each.size * each.factor) + " " + each.unit));
  return [view.chosen, [...loads, ...arrows].join(", ")].filter(Boolean).join(": ");
};
const at = values => { const i = Math.min(Math.floor(shown()), last), next = values[Math.min(i + 1, last)]; return values[i] + (next - values[i]) * (shown() - i); };
/* ---- time ---- */

const seconds = () => film.span[0] + (film.span[1] - film.span[0]) * (last ? now / last : 0);
const set = value => { now = Math.min(Math.max(value, 0), last); dirty = true; };
const play = on => {
  playing = on && last > 0;
  if (playing && now >= last) set(0);
  button.textContent = playing ? "Pause" : "Play";
  before = 0;
};
const frame = stamp => {
  if (playing && before) {
    const next = now + (stamp - before) / 1000 * film.speed * rate / (film.span[1] - film.span[0]) * last;
    set(next >= last ? 0 : next);
  }
  before = stamp;
  if (dirty) {
    dirty = false;
    slider.value = now;
    clock.textContent = seconds().toPrecision(3) + " s";
    slider.setAttribute("aria-valuetext", clock.textContent);
    const start = performance.now();
    draw();
    film.cost = performance.now() - start;
  }
  requestAnimationFrame(frame);
};
/* Films that replace each other, as behind sliders, go on where the one before is: a new one asks the frames of its page. */
const state = () => ({group: film.group, zerodrift: "state", time: seconds(), playing, rate, view: [view.zoom, view.turn, view.tilt, view.shift], chosen: view.chosen});
addEventListener("message", ({data, source}) => {
  if (data?.zerodrift === "play") play(data.on);          // a card of the site
  if (!film.group || data?.group !== film.group) return;
  if (data.zerodrift === "where" && source !== window) source.postMessage(state(), "*");
  if (data.zerodrift !== "state" || state.known) return;
  state.known = true;
  [view.zoom, view.turn, view.tilt, view.shift] = data.view;
  [rate, view.chosen] = [data.rate, data.chosen];
  speeds.value = rate;
  set((data.time - film.span[0]) / (film.span[1] - film.span[0]) * last);
  play(data.playing);
});
if (film.group) for (let i = 0; i < parent.length; i++) if (parent[i] !== window) parent[i].postMessage({group: film.group, zerodrift: "where"}, "*");
window.zerodrift = {film, tones, play, show: value => { play(false); set(value); draw(); }, choose: name => choose(name), get now() { return now; }, get playing() { return playing; },
  table, get told() { return told(); }, get spots() { return picture.spots.map(({name, at}) => ({name, at: project(at)})); }};

button.addEventListener("click", () => play(!playing));
slider.addEventListener("input", () => { play(false); set(+slider.value); });
speeds.addEventListener("change", () => { rate = +speeds.value; });
document.addEventListener("keydown", event => {
  if (event.target === speeds || event.target === more || (event.target === button && event.key === " ")) return;
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const step = {ArrowRight: 1, ArrowLeft: -1, PageDown: 10, PageUp: -10}[event.key];
  const way = {ArrowRight: [-1, 0], ArrowLeft: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
  if (event.key === " ") play(!playing);
  else if (space && event.shiftKey && way) turnBy(way[0] / 15, way[1] / 15);
  else if (step) { play(false); set(Math.round(now) + step); }
  else if (event.key === "Home") set(0);
  else if (event.key === "End") set(last);
  else if (event.key === "n" || event.key === "N") choose(next(event.key === "n" ? 1 : -1));
  else if (event.key === "+" || event.key === "-") zoomBy(event.key === "+" ? 1.2 : 1 / 1.2);
  else return;
  event.preventDefault();
});
let held = null;
canvas.addEventListener("pointerdown", event => { held = [event.clientX, event.clientY, false]; canvas.setPointerCapture(event.pointerId); });
canvas.addEventListener("pointermove", event => {
  if (!held) return;
  const x = event.clientX - held[0], y = event.clientY - held[1];
  if (!held[2] && Math.hypot(x, y) < 4) return;
  if (space && !event.shiftKey) turnBy(x / 150, y / 150); else view.shift = [view.shift[0] + x, view.shift[1] + y];
  held = [event.clientX, event.clientY, true];
  dirty = true;
});
canvas.addEventListener("pointerup", event => {
  if (held && !held[2]) choose(nearest(event));
  held = null;
});
const nearest = event => {
  const box = canvas.getBoundingClientRect();
  let best = 26, found = null;
  for (const {name, at} of [...picture.spots].sort((a, b) => hasLoad(b.name) - hasLoad(a.name))) {     // of a joint and a body in one place, the joint
    const [x, y] = project(at), far = Math.hypot(x - event.clientX + box.left, y - event.clientY + box.top);
    if (far < best - 0.5) { best = far; found = name; }
  }
  return found;
};
const hasLoad = name => film.layers.some(layer => layer.loads.some(each => each.name === name));
const next = way => {
  const names = [...new Set(picture.spots.map(each => each.name))];
  return names[(names.indexOf(view.chosen) + way + names.length) % names.length] ?? null;
};
const choose = name => {
  view.chosen = name;
  note.textContent = view.chosen ? told() : thinned;
  dirty = true;
};
canvas.addEventListener("wheel", event => {
  if (!event.ctrlKey) return;
  event.preventDefault();
  zoomBy(Math.exp(-event.deltaY / 300));
}, {passive: false});
canvas.addEventListener("dblclick", () => { view.zoom = 1; view.shift = [0, 0]; dirty = true; });
new ResizeObserver(() => { dirty = true; }).observe(document.body);
const moment = /^#t=([\d.e+-]+)$/.exec(location.hash);        // a link to a moment
play(playing && !moment);
if (moment && last) set((moment[1] - film.span[0]) / (film.span[1] - film.span[0]) * last);
requestAnimationFrame(frame);
})();

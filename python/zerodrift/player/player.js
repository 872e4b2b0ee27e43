"use strict";
(() => {
const film = JSON.parse(document.getElementById("scene").textContent);
const space = film.dimension === 3, last = film.samples - 1;
const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
let now = 0, playing = last > 0 && !still, before = 0, rate = 1, chosen = null, dirty = true;
let zoom = 1, turn = -0.9, tilt = 0.42, shift = [0, 0];

/* ---- numbers ---- */

const bytes = text => Uint8Array.from(atob(text), c => c.charCodeAt(0)).buffer;
for (const layer of film.layers) layer.table = new Uint16Array(bytes(layer.points));
for (const line of [...film.graphs, ...film.trust]) line.values = new Float32Array(bytes(line.values));

const place = (layer, number) => {        // of a point, on the straight line between two samples
  if (number < 0) return layer.fixed[-1 - number];
  const i = Math.min(Math.floor(now), last), share = now - i, d = film.dimension, to = [];
  for (let k = 0; k < d; k++) {
    const a = layer.table[(i * layer.moving + number) * d + k], b = layer.table[(Math.min(i + 1, last) * layer.moving + number) * d + k];
    to.push(film.box[0][k] + (film.box[1][k] - film.box[0][k]) * (a + (b - a) * share) / 65535);
  }
  return to;
};
const sub = (a, b) => a.map((x, i) => x - b[i]), add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
const length = a => Math.hypot(...a), unit = a => { const l = length(a) || 1; return a.map(x => x / l); };
const across = a => [-a[1], a[0]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/* ---- page ---- */

const make = (tag, parent, attributes = {}) => {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  return parent.appendChild(element);
};
const stage = make("div", document.body, {class: "stage"});
const canvas = make("canvas", stage, {role: "img", tabindex: "0", "aria-label": "Film of " + film.name + (space ? "; drag turns, arrow keys step" : "; arrow keys step")});
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
const trust = film.trust.length ? make("canvas", make("div", document.body, {class: "trust"}), {role: "img", "aria-label": "Position violation and energy error over time"}) : null;
const note = make("div", document.body, {class: "note", "aria-live": "polite"});

const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
let tones = {};
const probe = make("span", document.body, {hidden: ""});
const readColours = () => {     // light-dark() as it is seen
  for (const name of ["paper", "ink", "grey", "body", "line", "accent", "force", "path", "second", "third"]) {
    probe.style.color = "var(--" + name + ")";
    tones[name] = getComputedStyle(probe).color;
  }
  dirty = true;
};
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", readColours);

/* ---- view ---- */

let pen, scale, middle, width, height;
const centre = film.low.map((x, i) => (x + film.high[i]) / 2), extent = sub(film.high, film.low), reach = length(extent) || 1;
const fit = (element, context) => {
  const ratio = devicePixelRatio || 1, box = element.getBoundingClientRect();
  if (element.width !== Math.round(box.width * ratio) || element.height !== Math.round(box.height * ratio)) {
    element.width = Math.round(box.width * ratio);
    element.height = Math.round(box.height * ratio);
  }
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return [box.width, box.height];
};
const project = at => {         // (x, y, depth, scale there) on the screen
  if (!space) return [middle[0] + (at[0] - centre[0]) * scale, middle[1] - (at[1] - centre[1]) * scale, 0, scale];
  const [x, y0, z0] = sub(at, centre), y = film.upside ? -y0 : y0, z = film.upside ? -z0 : z0, c = Math.cos(turn), s = Math.sin(turn), ct = Math.cos(tilt), st = Math.sin(tilt);
  const right = c * x + s * y, deep = -s * x + c * y, up = ct * z - st * deep, depth = ct * deep + st * z;
  const seen = scale * 3 * reach / (3 * reach + depth);
  return [middle[0] + right * seen, middle[1] - up * seen, depth, seen];
};
const begin = () => {
  pen = canvas.getContext("2d");
  [width, height] = fit(canvas, pen);
  const margin = space ? 30 : 34;
  scale = zoom * (space ? 1.2 * Math.min(width, height) / reach
    : Math.min((width - 2 * margin) / Math.max(extent[0], 0.2 * reach), (height - 2 * margin) / Math.max(extent[1], 0.2 * reach)));
  middle = [width / 2 + shift[0], height / 2 + shift[1]];
  pen.clearRect(0, 0, width, height);
  pen.lineCap = pen.lineJoin = "round";
};

/* ---- marks: lists of [depth, function that draws], in the picture's units ---- */

let marks = [], spots = [];
const put = (points, how) => {
  const seen = points.map(project), depth = space ? seen.reduce((sum, p) => sum + p[2], 0) / seen.length : 0;
  marks.push([depth, marks.length, () => how(seen)]);
};
const trace = (seen, closed) => {
  pen.beginPath();
  seen.forEach((p, i) => i ? pen.lineTo(p[0], p[1]) : pen.moveTo(p[0], p[1]));
  if (closed) pen.closePath();
};
const line = (points, tone, wide, dash = []) => put(points, seen => {
  trace(seen);
  pen.setLineDash(dash);
  pen.strokeStyle = tone;
  pen.lineWidth = wide;
  pen.stroke();
  pen.setLineDash([]);
});
const area = (points, face, edge, wide = 1.2) => put(points, seen => {
  trace(seen, true);
  if (face) { pen.fillStyle = face; pen.fill(); }
  if (edge) { pen.strokeStyle = edge; pen.lineWidth = wide; pen.stroke(); }
});
const dot = (at, radius, face, edge, wide = 1.4) => put([at], ([p]) => {
  pen.beginPath();
  pen.arc(p[0], p[1], Math.max(radius * p[3], 1.8), 0, 2 * Math.PI);
  if (face) { pen.fillStyle = face; pen.fill(); }
  if (edge) { pen.strokeStyle = edge; pen.lineWidth = wide; pen.stroke(); }
  const round = radius * p[3];
  if (!space || !face || round < 4) return;       // a sphere
  const shine = pen.createRadialGradient(p[0] - 0.35 * round, p[1] - 0.4 * round, 0, p[0], p[1], round);
  shine.addColorStop(0, "#fff9");
  shine.addColorStop(1, "#fff0");
  pen.fillStyle = shine;
  pen.fill();
});
const bar = (points, wide, tone, edge) => {      // a rod with round ends and an outline; long ones in parts, so that depths are right
  const parts = space ? Math.max(1, Math.min(8, Math.ceil(length(sub(points[1], points[0])) / (0.15 * reach)))) : 1;
  for (let i = 0; i < parts; i++) {
    const ends = space ? [i / parts, (i + 1) / parts].map(s => add(points[0], sub(points[1], points[0]), s)) : points;
    put(ends, seen => {
      const broad = Math.max(wide * seen[0][3], 2);
      const shine = space && broad > 5 ? 0.22 * broad : 0;       // of a round rod, lit from above
      for (const [more, colourOf, up] of [[2, edge, 0], [0, tone, 0], ...(shine ? [[-0.7 * broad, "#fff6", shine]] : [])]) {
        pen.lineCap = space && more ? "butt" : "round";
        trace(up ? seen.map(([x, y]) => [x, y - up]) : seen);
        pen.strokeStyle = colourOf;
        pen.lineWidth = broad + more;
        pen.stroke();
      }
      pen.lineCap = "round";
    });
  }
};
const arrow = (from, to, tone, wide = 2.2) => put([from, to], ([a, b]) => {
  const far = Math.hypot(b[0] - a[0], b[1] - a[1]);
  if (far < 2) return;
  const x = (b[0] - a[0]) / far, y = (b[1] - a[1]) / far, head = Math.min(11, 0.6 * far);
  pen.strokeStyle = pen.fillStyle = tone;
  pen.lineWidth = wide;
  trace([a, [b[0] - 0.8 * head * x, b[1] - 0.8 * head * y]]);
  pen.stroke();
  trace([b, [b[0] - head * x + 0.4 * head * y, b[1] - head * y - 0.4 * head * x], [b[0] - head * x - 0.4 * head * y, b[1] - head * y + 0.4 * head * x]], true);
  pen.fill();
});
const box = (at, axis, along, aside, face, edge) => {
  const side = across(axis);
  area([[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([a, b]) => add(add(at, axis, a * along), side, b * aside)), face, edge);
};
const circle = (at, radius, first = [1, 0]) => Array.from({length: 49}, (_, i) => {
  const angle = 2 * Math.PI * i / 48, side = across(first);
  return add(add(at, first, radius * Math.cos(angle)), side, radius * Math.sin(angle));
});
const zigzag = (a, b, wide, turns) => {
  const along = sub(b, a), side = space ? unit(cross(unit(along), Math.abs(along[2]) < 0.9 * length(along) ? [0, 0, 1] : [1, 0, 0])) : across(unit(along)), points = [a];
  for (let i = 0; i <= 2 * turns; i++)
    points.push(add(add(a, along, 0.15 + 0.7 * i / (2 * turns)), side, i === 0 || i === 2 * turns ? 0 : wide * (i % 2 ? 1 : -1)));
  return [...points, b];
};
const ground = (at, size) => {
  const low = 2.3 * size, wide = 2.1 * size;
  if (space) return area([[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => add(at, [a * size * 1.6, b * size * 1.6, 0])), tones.body, tones.line, 0.8);
  area([at, add(at, [-wide, -low]), add(at, [wide, -low])], tones.body, tones.line);
  for (let i = -3; i <= 3; i++) line([add(at, [i * 0.75 * size, -low]), add(at, [(i - 0.9) * 0.75 * size, -low - 0.9 * size])], tones.line, 1);
};
const hatched = (a, b, away, size) => {
  line([a, b], tones.line, 1.6);
  const along = unit(sub(b, a)), count = Math.max(2, Math.round(length(sub(b, a)) / (1.6 * size)));
  for (let i = 0; i <= count; i++) {
    const at = add(a, sub(b, a), i / count);
    line([at, add(add(at, away, -size), along, -0.8 * size)], tones.line, 0.9);
  }
};
const turning = (at, radius, number, tone) => {
  const from = -0.75 * Math.PI, sign = number >= 0 ? 1 : -1;
  const points = Array.from({length: 25}, (_, i) => { const a = (sign > 0 ? from : Math.PI - from) + sign * 1.45 * Math.PI * i / 24; return add(at, [radius * Math.cos(a), radius * Math.sin(a)]); });
  line(points.slice(0, 24), tone, 1.8);
  arrow(points[20], points[24], tone, 1.8);
};

/* ---- kinds of shapes: (points, number, size, tone of the body, its edge) ---- */

const wheel = (p, r, size, face, edge) => { area(circle(p[0], r, unit(p[1])), face, edge, 1.6); line([p[0], add(p[0], unit(p[1]), r)], edge, 1.2); dot(p[0], 0.5 * size, edge); };
const flat = {
  link: (p, r, size, face, edge) => p.length === 2 || thin(p) ? bar(ends(p), 1.5 * size, face, edge) : area(hull(p), face, edge, 1.6),
  disc: (p, r, size, face, edge) => { dot(p[0], 2 * size, face, edge); line([p[0], add(p[0], p[1], 2 * size)], edge, 1.2); },
  particle: (p, r, size, face, edge) => p.forEach(at => dot(at, 1.7 * size, edge, tones.paper)),
  mark: (p, r, size) => dot(p[0], 0.45 * size, tones.ink),
  curve: (p, r, size, face, edge) => line(p, edge, 1.6),
  pin: (p, r, size) => dot(p[0], 0.85 * size, tones.paper, tones.ink, 1.5),
  ground: (p, r, size) => ground(p[0], size),
  wall: (p, r, size) => { const a = across(unit(p[1])); hatched(add(p[0], a, -2 * size), add(p[0], a, 2 * size), unit(p[1]), size); },
  rail: (p, r, size) => hatched(add(p[0], unit(sub(p[1], p[0])), -2 * size), add(p[1], unit(sub(p[1], p[0])), 2 * size), p[2], size),
  road: (p, r, size) => { const along = unit(p[2]); hatched(add(p[0], along, -2 * size), add(p[1], along, 2 * size), across(along), size); },
  groove: (p, r, size, face, edge) => { bar([p[0], p[1]], 2.4 * size, tones.paper, edge); },
  guide: (p, r, size, face, edge) => line([p[0], p[1]], edge, 2),
  slider: (p, r, size, face, edge) => box(p[0], unit(p[1]), 2 * size, 1.3 * size, face, edge),
  block: (p, r, size, face, edge) => box(p[0], unit(p[1]), 1.6 * size, 1 * size, face, edge),
  weld: (p, r, size, face, edge) => box(p[0], unit(p[1]), 0.7 * size, 0.7 * size, edge, null),
  rod: (p, r, size, face, edge) => line(p, edge, 1.8),
  blade: (p, r, size, face, edge) => bar([add(p[0], unit(p[1]), -2.2 * size), add(p[0], unit(p[1]), 2.2 * size)], 0.5 * size, tones.ink, tones.ink),
  wheel, gear: wheel, ring: (p, r, size, face, edge) => area(circle(p[0], r), null, edge, 3),
  rack: (p, r, size, face, edge) => bar([p[0], p[1]], 0.9 * size, face, edge),
  cam: (p, r, size, face, edge) => area(p, face, edge),
  roller: (p, r, size, face, edge) => dot(p[0], Math.max(r, size), tones.paper, edge),
  coupled: (p, r, size) => line(p, tones.grey, 1, [3, 4]),
  spring: (p, r, size) => line(zigzag(shifted(p, r, size)[0], shifted(p, r, size)[1], 1.1 * size, 7), tones.third, 1.5),
  damper: (p, r, size, face, edge) => { const [a, b] = shifted(p, r, size); line([a, b], edge, 1.2); bar([add(a, sub(b, a), 0.38), add(a, sub(b, a), 0.6)], 1.5 * size, face, edge); },
  cylinder: (p, r, size, face, edge) => { line(p, edge, 2.4); bar([p[0], add(p[0], sub(p[1], p[0]), 0.55)], 1.7 * size, face, edge); },
  spiral: (p, r, size) => line(Array.from({length: 60}, (_, i) => { const a = (4 * Math.PI + r) * i / 59; return add(p[0], [size * (0.8 + 2.2 * i / 59) * Math.cos(a), size * (0.8 + 2.2 * i / 59) * Math.sin(a)]); }), tones.third, 1.4),
  bushing: (p, r, size, face, edge) => { dot(p[0], 1.6 * size, null, tones.third, 3); dot(p[0], 0.6 * size, edge); },
  motor: (p, r, size) => turning(p[0], 3.1 * size, r, tones.accent),
  drive: (p, r, size) => { const at = add(p[0], p[2], 2.8 * size), s = r >= 0 ? 1 : -1; arrow(add(at, p[1], -3 * s * size), add(at, p[1], 3 * s * size), tones.accent, 1.8); },
  load: (p, r, size) => arrow(p[0], add(p[0], p[1], 8 * size), tones.force, 2),
  load_symbol: (p, r, size) => arrow(p[0], add(p[0], p[1], 8 * size), tones.grey, 1.4),
  moment: (p, r, size) => turning(p[0], 3.8 * size, r, tones.force),
};
/* Faces in space are lit from above, on the viewer's left: as bright as their normal is near to the light, whichever side is seen. */
const light = unit([-0.35, -0.5, 0.8]);
const lit = (p, tone) => {
  const parts = /rgba?\(([^)]*)\)/.exec(tone)?.[1].split(/[ ,]+/).map(Number);
  if (!parts || parts.length > 3) return tone;
  const normal = unit(cross(sub(p[1], p[0]), sub(p[Math.min(2, p.length - 1)], p[0])));
  const share = 0.72 + 0.36 * Math.abs(normal.reduce((sum, x, i) => sum + x * light[i], 0));
  return `rgb(${parts.map(x => Math.min(255, Math.round(x * share))).join(",")})`;
};
const face3 = (p, face, edge, wide) => area(p, lit(p, face), edge, wide);
const faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
const solid = {
  bar: (p, r, size, face, edge) => bar(p, 0.9 * size, face, edge),
  plate: (p, r, size, face, edge) => face3(p, face, edge),
  box: (p, r, size, face, edge) => faces.forEach(each => face3(each.map(i => p[i]), face, edge, 0.8)),
  disc: (p, r, size, face, edge) => face3(p, face, edge, 1.6), ring: (p, r, size, face, edge) => line([...p, p[0]], edge, 1.4),
  patch: (p, r, size) => area([[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([a, b]) => add(add(p[0], p[1], 2 * a * size), p[2], 2 * b * size)), null, tones.accent),
  rod: (p, r, size, face, edge) => line(p, edge, 1.6), track: (p, r, size) => line(p, tones.grey, 1, [2, 4]),
  spring: (p, r, size) => line(zigzag(p[0], p[1], 0.9 * size, 9), tones.third, 1.6),
  pin: (p, r, size) => bar([add(p[0], p[1], -1.5 * size), add(p[0], p[1], 1.5 * size)], 0.7 * size, tones.second, tones.paper),
  sleeve: (p, r, size) => bar([add(p[0], p[1], -2 * size), add(p[0], p[1], 2 * size)], 1.5 * size, tones.accent, tones.paper),
  dot: (p, r, size, face, edge) => p.forEach(at => dot(at, 1.1 * size, edge)), weld: (p, r, size) => dot(p[0], 0.6 * size, tones.ink),
  ball: (p, r, size) => dot(p[0], 0.9 * size, tones.second, tones.paper), bushing: (p, r, size) => dot(p[0], 1.2 * size, null, tones.third, 3),
  ground: (p, r, size) => ground(p[0], size),
};
const ends = p => { let best = [p[0], p[1]]; for (const a of p) for (const b of p) if (length(sub(a, b)) > length(sub(...best))) best = [a, b]; return best; };
const thin = p => { const [a, b] = ends(p), side = across(unit(sub(b, a))); return p.every(at => Math.abs(at.reduce((s, x, i) => s + (x - a[i]) * side[i], 0)) < 0.02 * length(sub(b, a))); };
const hull = p => {
  const sorted = [...p].sort((a, b) => a[0] - b[0] || a[1] - b[1]), half = list => list.reduce((kept, at) => {
    while (kept.length > 1 && (kept.at(-1)[0] - kept.at(-2)[0]) * (at[1] - kept.at(-2)[1]) <= (kept.at(-1)[1] - kept.at(-2)[1]) * (at[0] - kept.at(-2)[0])) kept.pop();
    return [...kept, at];
  }, []);
  return [...half(sorted).slice(0, -1), ...half([...sorted].reverse()).slice(0, -1)];
};
const shifted = (p, r, size) => { const side = across(unit(sub(p[1], p[0]))); return p.map(at => add(at, side, (r || 0) * 2.2 * size)); };

/* ---- a picture ---- */

const anchor = points => points.length > 1 ? points[0].map((x, i) => (x + points[1][i]) / 2) : points[0];
const single = new Set(["pin", "ball", "weld", "ground", "sleeve", "slider", "block", "wheel", "gear", "patch", "motor", "drive", "disc", "particle", "dot", "bushing", "blade", "mark"]);
const back = ["ring", "gear", "cam", "ground", "wall", "rail", "road", "wheel", "disc", "coupled", "guide", "link", "curve", "groove", "rod", "cylinder", "damper", "spring", "slider", "rack", "block", "bushing", "weld", "particle", "roller", "spiral", "pin"];
const draw = () => {
  begin();
  marks = [];
  spots = [];
  film.layers.forEach((layer, number) => {
    const face = number ? "transparent" : tones.body, edge = [tones.line, tones.second, tones.accent][number % 3];
    const order = space ? layer.shapes : [...layer.shapes].sort((a, b) => (back.indexOf(a[0]) + 1 || 99) - (back.indexOf(b[0]) + 1 || 99));
    for (const [kind, name, numbers, radius] of order) {
      const points = numbers.map(i => place(layer, i));
      const how = (space ? solid : flat)[kind] || ((p, r, size, f, e) => line(p, e, 1.4));
      how(points, radius, film.pin * (space ? 1.25 : 1), face, edge);
      if (name) spots.push({name, at: single.has(kind) ? points[0] : anchor(points)});
    }
    for (const way of layer.paths) line(way, tones.path, 1.5, [7, 4]);
    for (const each of layer.arrows) {
      const at = place(layer, each.at), force = place(layer, each.to);
      each.size = length(force) * each.scale;
      if (length(force) > 0.01) arrow(at, add(at, force, film.arrow), tones.force, 2.4);
    }
  });
  if (space) marks.sort((a, b) => b[0] - a[0] || a[1] - b[1]);
  marks.forEach(each => each[2]());
  labels();
  if (trust) lines(trust, film.trust.map(each => ({...each, log: true})), true);
  graphs.forEach(each => lines(each.canvas, each.lines, false, each.unit));
};
const words = (text, x, y, tone = tones.ink) => {
  pen.font = "12px system-ui, sans-serif";
  pen.lineWidth = 3;
  pen.strokeStyle = tones.paper;
  pen.strokeText(text, x, y);
  pen.fillStyle = tone;
  pen.fillText(text, x, y);
};
const labels = () => {
  const shown = new Set();
  if (film.names) for (const {name, at} of spots) {
    if (shown.has(name)) continue;
    shown.add(name);
    const [x, y] = project(at);
    words(name, x + 8, y - 7);
  }
  const scales = film.layers.flatMap(layer => layer.arrows);
  if (scales.length) {
    const most = scales[0].scale, long = film.arrow * scale;
    pen.strokeStyle = tones.force;
    pen.lineWidth = 2.4;
    trace([[12, height - 12], [12 + long, height - 12]]);
    pen.stroke();
    words(number(most) + " N", 16, height - 18, tones.force);
  }
  if (film.layers.length > 1) film.layers.forEach((layer, i) => words(layer.label, 12, 18 + 16 * i, [tones.line, tones.second, tones.accent][i % 3]));
  if (chosen) {
    const spot = spots.find(each => each.name === chosen);
    if (spot) {
      const [x, y] = project(spot.at);
      pen.beginPath();
      pen.arc(x, y, 13, 0, 2 * Math.PI);
      pen.strokeStyle = tones.accent;
      pen.lineWidth = 2;
      pen.stroke();
      const force = film.layers[0].arrows.find(each => each.name === chosen);
      words(chosen + (force ? ": " + number(force.size) + " N" : ""), x + 16, y + 5, tones.accent);
    }
  }
};
const number = x => x === 0 ? "0" : Math.abs(x) >= 1e4 || Math.abs(x) < 1e-2 ? x.toExponential(2) : x.toPrecision(3);
const hues = () => [tones.accent, tones.second, tones.third, tones.ink, tones.grey, tones.force];
const lines = (element, all, slim, unitOf) => {        // lines over time, with a cursor
  const brush = element.getContext("2d"), [w, h] = fit(element, brush), left = slim ? 0 : 8, top = slim ? 14 : 20, low = slim ? 4 : 8;
  brush.clearRect(0, 0, w, h);
  const tiny = 1e-18, value = (line, x) => line.log ? Math.log10(Math.max(Math.abs(x), tiny)) : x;
  brush.font = "11px system-ui, sans-serif";
  let word = left;
  const shared = slim ? null : [Math.min(...all.map(each => each.least)), Math.max(...all.map(each => each.most))];
  all.forEach((line, i) => {
    const [a, b] = shared || [Math.min(...Array.from(line.values, x => value(line, x))), Math.max(...Array.from(line.values, x => value(line, x)))];
    const y = x => h - low - (h - top - low) * (b > a ? (value(line, x) - a) / (b - a) : 0.5);
    brush.beginPath();
    line.values.forEach((x, k) => brush[k ? "lineTo" : "moveTo"](left + (w - 2 * left) * k / Math.max(last, 1), y(x)));
    brush.strokeStyle = brush.fillStyle = hues()[i % 6];
    brush.lineWidth = 1.5;
    brush.stroke();
    const here = line.values[Math.round(now)];
    const text = (film.layers.length > 1 ? line.label + " " : "") + line.name + " " + (slim ? "\u2264 " + number(line.most) : number(here)) + " " + line.unit;
    brush.fillText(text, word, 11);
    word += brush.measureText(text).width + 16;
  });
  const x = left + (w - 2 * left) * now / Math.max(last, 1);
  brush.strokeStyle = tones.ink;
  brush.lineWidth = 1;
  brush.beginPath();
  brush.moveTo(x, top);
  brush.lineTo(x, h);
  brush.stroke();
};

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
window.zerodrift = {film, play, show: value => { play(false); set(value); draw(); }, get now() { return now; }};

button.addEventListener("click", () => play(!playing));
slider.addEventListener("input", () => { play(false); set(+slider.value); });
speeds.addEventListener("change", () => { rate = +speeds.value; });
document.addEventListener("keydown", event => {
  if (event.target === speeds || (event.target === button && event.key === " ")) return;
  const step = {ArrowRight: 1, ArrowLeft: -1, PageDown: 10, PageUp: -10}[event.key];
  if (event.key === " ") play(!playing);
  else if (step) { play(false); set(Math.round(now) + step); }
  else if (event.key === "Home") set(0);
  else if (event.key === "End") set(last);
  else return;
  event.preventDefault();
});
let held = null;
canvas.addEventListener("pointerdown", event => { held = [event.clientX, event.clientY, false]; canvas.setPointerCapture(event.pointerId); });
canvas.addEventListener("pointermove", event => {
  if (!held) return;
  const x = event.clientX - held[0], y = event.clientY - held[1];
  if (!held[2] && Math.hypot(x, y) < 4) return;
  if (space && !event.shiftKey) { turn -= x / 150; tilt = Math.min(Math.max(tilt + y / 150, -1.5), 1.5); } else shift = [shift[0] + x, shift[1] + y];
  held = [event.clientX, event.clientY, true];
  dirty = true;
});
canvas.addEventListener("pointerup", event => {
  if (held && !held[2]) choose(event);
  held = null;
});
const choose = event => {
  const box = canvas.getBoundingClientRect();
  let best = 26;
  chosen = null;
  for (const {name, at} of spots) {
    const [x, y] = project(at), far = Math.hypot(x - event.clientX + box.left, y - event.clientY + box.top);
    if (far < best) { best = far; chosen = name; }
  }
  note.textContent = chosen ? chosen : "";
  dirty = true;
};
canvas.addEventListener("wheel", event => {
  if (!event.ctrlKey) return;
  event.preventDefault();
  zoom = Math.min(Math.max(zoom * Math.exp(-event.deltaY / 300), 0.2), 20);
  dirty = true;
}, {passive: false});
canvas.addEventListener("dblclick", () => { zoom = 1; shift = [0, 0]; dirty = true; });
new ResizeObserver(() => { dirty = true; }).observe(document.body);
readColours();
play(playing);
requestAnimationFrame(frame);
})();

"use strict";
/* Pictures of the shapes of a scene, in the plane and in space, with perspective, shading and order of depth. The caller locates the points of
 * each layer: `layer.at`, and `layer.fixed` of those that rest. `changed` is called when the picture must be drawn anew. */
const pictureOf = (film, canvas, changed) => {
const space = film.dimension === 3, view = {zoom: 1, turn: -0.9, tilt: 0.42, shift: [0, 0], chosen: null};
const place = (layer, number) => number < 0 ? layer.fixed[-1 - number] : layer.at[number];
const sub = (a, b) => a.map((x, i) => x - b[i]), add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
const length = a => Math.hypot(...a), unit = a => { const l = length(a) || 1; return a.map(x => x / l); };
const across = a => [-a[1], a[0]];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/* ---- colours ---- */

const tones = {};
const probe = document.body.appendChild(document.createElement("span"));
probe.hidden = true;
const readColours = () => {     // light-dark() as it is seen
  for (const name of ["paper", "ink", "grey", "body", "line", "accent", "force", "path", "second", "third"]) {
    probe.style.color = "var(--" + name + ")";
    tones[name] = getComputedStyle(probe).color;
  }
  changed();
};
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", readColours);

/* ---- view ---- */

let pen, scale, middle, width, height;
let centre, extent, reach, seenFirst;
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
  const [x, y0, z0] = sub(at, centre), y = film.upside ? -y0 : y0, z = film.upside ? -z0 : z0, c = Math.cos(view.turn), s = Math.sin(view.turn), ct = Math.cos(view.tilt), st = Math.sin(view.tilt);
  const right = c * x + s * y, deep = -s * x + c * y, up = ct * z - st * deep, depth = ct * deep + st * z;
  const seen = scale * 3 * reach / (3 * reach + depth);
  return [middle[0] + right * seen, middle[1] - up * seen, depth, seen];
};
const unproject = (screen, depth) => {          // the point at this depth that is seen there
  const seen = space ? scale * 3 * reach / (3 * reach + depth) : scale, right = (screen[0] - middle[0]) / seen, up = (middle[1] - screen[1]) / seen;
  if (!space) return [centre[0] + right, centre[1] + up];
  const c = Math.cos(view.turn), s = Math.sin(view.turn), ct = Math.cos(view.tilt), st = Math.sin(view.tilt);
  const deep = ct * depth - st * up, sign = film.upside ? -1 : 1;
  return add(centre, [c * right - s * deep, sign * (s * right + c * deep), sign * (ct * up + st * depth)]);
};
const frame = () => {           // the box around all motion, and its width and height in metres of the screen as the film begins
  centre = film.low.map((x, i) => (x + film.high[i]) / 2);
  extent = film.follow ? film.low.map(() => film.follow) : sub(film.high, film.low);
  reach = length(extent) || 1;
  if (!space) return;
  [scale, middle] = [1, [0, 0]];
  const corners = Array.from({length: 8}, (_, i) => project(centre.map((x, k) => x + (i >> k & 1 ? 0.5 : -0.5) * extent[k])));
  seenFirst = [0, 1].map(k => Math.max(0.3 * reach, 2 * Math.max(...corners.map(at => Math.abs(at[k])))));
};
frame();
const begin = () => {
  pen = canvas.getContext("2d");
  [width, height] = fit(canvas, pen);
  const margin = space ? 30 : 34;
  scale = view.zoom * (space ? Math.min((width - 2 * margin) / seenFirst[0], (height - 2 * margin) / seenFirst[1])
    : Math.min((width - 2 * margin) / Math.max(extent[0], 0.2 * reach), (height - 2 * margin) / Math.max(extent[1], 0.2 * reach)));
  middle = [width / 2 + view.shift[0], height / 2 + view.shift[1]];
  pen.clearRect(0, 0, width, height);
  pen.lineCap = pen.lineJoin = "round";
};
/* ---- marks: the path of each, and how paths of one style are painted; among many those of one style are painted together ---- */

let marks = [], spots = [];
const MANY = 600, SLICES = 48;      // marks, and slices of depth within which they may change places
const SMALLEST = 1.1, SHADOW = 0.16;        // radius of a pin on the screen, below which bars alone are drawn; opacity
const put = (points, style, add, paint) => {
  const seen = points.map(project);
  marks.push({depth: space ? seen.reduce((sum, p) => sum + p[2], 0) / seen.length : 0, order: marks.length, style, seen, add, paint});
};
const paintAll = () => {
  const many = marks.length > MANY;
  if (space) {
    const slice = many ? 2 * reach / SLICES : 0;
    for (const each of marks) if (slice) each.depth = Math.round(each.depth / slice);
    marks.sort((a, b) => b.depth - a.depth || (many && a.style !== b.style ? a.style < b.style ? -1 : 1 : a.order - b.order));
  }
  for (let i = 0; i < marks.length;) {
    let next = i + 1;
    if (many && marks[i].style) while (next < marks.length && marks[next].style === marks[i].style) next++;
    const run = marks.slice(i, next);
    pen.beginPath();
    for (const each of run) each.add(each.seen);
    run[0].paint(run, many);
    i = next;
  }
};
const trace = (seen, closed) => {
  seen.forEach((p, i) => i ? pen.lineTo(p[0], p[1]) : pen.moveTo(p[0], p[1]));
  if (closed) pen.closePath();
};
const stroke = (tone, wide) => { pen.strokeStyle = tone; pen.lineWidth = wide; pen.stroke(); };
const fill = tone => { pen.fillStyle = tone; pen.fill(); };
const line = (points, tone, wide, dash = []) => put(points, "line" + tone + wide + dash, seen => trace(seen), () => {
  pen.setLineDash(dash);
  stroke(tone, wide);
  pen.setLineDash([]);
});
const area = (points, face, edge, wide = 1.2) => put(points, "", seen => trace(seen, true), () => {
  if (face) fill(face);
  if (edge) stroke(edge, wide);
});
const dot = (at, radius, face, edge, wide = 1.4) => put([at], "dot" + face + edge + wide, ([p]) => {
  const round = Math.max(radius * p[3], 1.8);
  pen.moveTo(p[0] + round, p[1]);
  pen.arc(p[0], p[1], round, 0, 2 * Math.PI);
}, (run, many) => {
  if (face) fill(face);
  if (edge) stroke(edge, wide);
  const p = run[0].seen[0], round = radius * p[3];
  if (!space || many || !face || round < 4) return;       // a sphere
  const shine = pen.createRadialGradient(p[0] - 0.35 * round, p[1] - 0.4 * round, 0, p[0], p[1], round);
  shine.addColorStop(0, "#fff9");
  shine.addColorStop(1, "#fff0");
  fill(shine);
});
const small = () => film.pin * scale < SMALLEST;       // of long chains neither joints nor outlines are seen
const bar = (points, wide, tone, edge) => {      // a rod with round ends and an outline; long ones in parts, so that depths are right
  const parts = space ? Math.max(1, Math.min(8, Math.ceil(length(sub(points[1], points[0])) / (0.15 * reach)))) : 1, isThin = small();
  for (let i = 0; i < parts; i++) {
    const ends = parts > 1 ? [i / parts, (i + 1) / parts].map(s => add(points[0], sub(points[1], points[0]), s)) : points;
    const broad = Math.max(Math.round(2 * wide * (space ? project(ends[0])[3] : scale)) / 2, 2);
    put(ends, "bar" + broad + tone + edge, seen => trace(seen), (run, many) => {
      pen.lineCap = space ? "butt" : "round";
      stroke(edge, isThin ? broad : broad + 2);
      pen.lineCap = "round";
      if (isThin) return;
      stroke(tone, broad);
      if (!space || many || broad <= 5) return;
      pen.beginPath();
      trace(run[0].seen.map(([x, y]) => [x, y - 0.22 * broad]));       // a round rod, lit from above
      stroke("#fff6", 0.3 * broad);
    });
  }
};
const arrow = (from, to, tone, wide = 2.2) => put([from, to], "", () => 0, ([{seen: [a, b]}]) => {
  const far = Math.hypot(b[0] - a[0], b[1] - a[1]);
  if (far < 2) return;
  const x = (b[0] - a[0]) / far, y = (b[1] - a[1]) / far, head = Math.min(11, 0.6 * far);
  trace([a, [b[0] - 0.8 * head * x, b[1] - 0.8 * head * y]]);
  stroke(tone, wide);
  pen.beginPath();
  trace([b, [b[0] - head * x + 0.4 * head * y, b[1] - head * y - 0.4 * head * x], [b[0] - head * x - 0.4 * head * y, b[1] - head * y + 0.4 * head * x]], true);
  fill(tone);
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
  stop: (p, r, size) => box(add(p[0], unit(p[1]), (r ? 2.7 : 2.2) * size), unit(p[1]), 0.7 * size, 1.7 * size, tones.line, null),
  road: (p, r, size) => { const along = unit(p[2]); hatched(add(p[0], along, -2 * size), add(p[1], along, 2 * size), across(along), size); },
  groove: (p, r, size, face, edge) => { bar([p[0], p[1]], 2.4 * size, tones.paper, edge); },
  guide: (p, r, size, face, edge) => line([p[0], p[1]], edge, 2),
  slider: (p, r, size, face, edge) => box(p[0], unit(p[1]), 2 * size, 1.3 * size, face, edge),
  block: (p, r, size, face, edge) => box(p[0], unit(p[1]), 1.6 * size, 1 * size, face, edge),
  weld: (p, r, size, face, edge) => box(p[0], unit(p[1]), 0.7 * size, 0.7 * size, edge, null),
  rod: (p, r, size, face, edge) => { if (!r || Math.abs(length(sub(p[1], p[0])) - r) < 1e-6 * r) line(p, edge, 1.8); },     // r: may be released
  blade: (p, r, size, face, edge) => bar([add(p[0], unit(p[1]), -4.5 * size), add(p[0], unit(p[1]), 4.5 * size)], 0.8 * size, tones.ink, tones.ink),
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
const glass = tone => tone.replace("rgb(", "rgba(").replace(")", ", 0.7)");        // boxes of inertia, through which one sees their joints
const middleOf = p => p[0].map((_, k) => p.reduce((sum, at) => sum + at[k], 0) / p.length);
const isTowards = middle => p => project(middleOf(p))[2] < project(middle)[2];       // faces of what is convex that are seen
const thick = (p, half, face, edge, wide) => {      // a flat part as a solid
  const centre = middleOf(p), normal = unit(cross(sub(p[0], centre), sub(p[Math.ceil(p.length / 3)], centre)));
  const [over, under] = [1, -1].map(sign => p.map(at => add(at, normal, sign * half))), seen = project(add(centre, normal, half))[2] < project(add(centre, normal, -half))[2] ? over : under;
  for (let i = 0; i < p.length; i++) {
    const k = (i + 1) % p.length, side = [under[i], under[k], over[k], over[i]];
    if (isTowards(centre)(side)) face3(side, face, p.length > 12 ? lit(side, face) : edge, 0.8);
  }
  face3(seen, face, edge, wide);
};
const axes = (p, size) => {         // of a body, from its box: x, y, z
  const at = middleOf(p), longest = Math.max(...[4, 2, 1].map(i => length(sub(p[i], p[0]))));
  [[4, "second"], [2, "third"], [1, "accent"]].forEach(([i, tone]) => {
    const along = sub(p[i], p[0]), far = 0.5 * length(along);
    bar([add(at, unit(along), far), add(at, unit(along), far + 0.3 * longest)], 0.35 * size, tones[tone], tones[tone]);
  });
};
const faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
const solid = {
  bar: (p, r, size, face, edge) => bar(p, 0.9 * size, face, edge),
  plate: (p, r, size, face, edge) => thick(p, 0.5 * size, face, edge, 1),
  box: (p, r, size, face, edge) => { faces.map(each => each.map(i => p[i])).filter(isTowards(middleOf(p))).forEach(each => area(each, glass(lit(each, face)), edge, 0.8)); axes(p, size); },
  disc: (p, r, size, face, edge) => thick(p.slice(0, -1), 0.6 * size, face, edge, 1.2), ring: (p, r, size, face, edge) => line([...p, p[0]], edge, 1.4),
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

/* In space a floor lies below all motion, on which parts have a shadow. What goes far is followed, and a grid at rest shows how it goes. */
const floorAt = () => film.upside ? film.high[2] : film.low[2];
const follow = () => {
  const layer = film.layers[0], seen = layer.shapes.map(each => each[2][0]).filter(n => n >= 0).map(n => place(layer, n));
  centre = film.low.map((_, k) => (Math.min(...seen.map(at => at[k])) + Math.max(...seen.map(at => at[k]))) / 2);
};
const grid = () => {
  const wide = film.follow || Math.max(extent[0], extent[1], 0.4 * extent[2]), size = wide / (film.follow ? 3 : 5), power = 10 ** Math.floor(Math.log10(size)), step = power * [1, 2, 5].findLast(each => each * power <= size * 1.001);
  const [a, b] = [0, 1].map(k => Math.round(centre[k] / step)), most = film.follow ? space ? 4 : 8 : Math.ceil(0.62 * wide / step), floor = space ? [floorAt()] : [];
  for (let i = -most; i <= most; i++) {
    line([[(a + i) * step, (b - most) * step, ...floor], [(a + i) * step, (b + most) * step, ...floor]], tones.body, 0.7);
    line([[(a - most) * step, (b + i) * step, ...floor], [(a + most) * step, (b + i) * step, ...floor]], tones.body, 0.7);
  }
  marks.forEach(each => { each.depth = Infinity; });
};
const shadow = points => {
  const seen = points.map(at => project([at[0], at[1], floorAt()]));
  marks.push({depth: 1e9, order: marks.length, style: "shadow" + (points.length > 2), seen, add: seen => trace(seen, points.length > 2), paint: () => {
    pen.globalAlpha = SHADOW;
    if (points.length > 2) fill(tones.ink); else stroke(tones.ink, Math.max(2, 1.5 * film.pin * scale));
    pen.globalAlpha = 1;
  }});
};
const shades = new Set(["bar", "plate", "disc", "ring", "box", "rod"]);

const anchor = points => points.length > 1 ? points[0].map((x, i) => (x + points[1][i]) / 2) : points[0];
const single = new Set(["pin", "ball", "weld", "ground", "sleeve", "slider", "block", "wheel", "gear", "patch", "motor", "drive", "disc", "particle", "dot", "bushing", "blade", "mark", "stop", "load", "load_symbol", "moment"]);
const joints = new Set(["pin", "ball", "weld", "sleeve", "dot", "particle", "mark"]);
const back = ["ring", "gear", "cam", "ground", "wall", "rail", "road", "wheel", "disc", "coupled", "guide", "stop", "link", "curve", "groove", "rod", "cylinder", "damper", "spring", "slider", "rack", "block", "bushing", "weld", "particle", "roller", "spiral", "pin"];
const draw = note => {
  begin();
  marks = [];
  spots = [];
  if (film.follow) follow();
  if (film.follow || space) grid();
  film.under?.(line, tones);
  film.layers.forEach((layer, number) => {
    const face = number ? "transparent" : tones.body, edge = [tones.line, tones.second, tones.accent][number % 3];
    layer.order ??= space ? layer.shapes : [...layer.shapes].sort((a, b) => (back.indexOf(a[0]) + 1 || 99) - (back.indexOf(b[0]) + 1 || 99));
    for (const [kind, name, numbers, radius] of layer.order) {
      if (joints.has(kind) && small()) continue;
      const points = numbers.map(i => place(layer, i));
      if (space && shades.has(kind)) (kind === "box" ? faces.map(each => each.map(i => points[i])) : [points]).forEach(shadow);
      const how = (space ? solid : flat)[kind] || ((p, r, size, f, e) => line(p, e, 1.4));
      how(points, radius, film.pin * (space ? 1.25 : 1), face, edge);
      if (name) spots.push({name, at: single.has(kind) ? points[0] : anchor(points), isSingle: single.has(kind)});
    }
    for (const way of layer.paths) line(way, tones.path, 1.5, [7, 4]);
    for (const each of layer.arrows) {
      const at = place(layer, each.at), force = place(layer, each.to);
      each.size = length(force) * each.scale;
      if (length(force) > 0.01) arrow(at, add(at, force, film.arrow), tones.force, 2.4);
    }
  });
  paintAll();
  labels(note);
};
const words = (text, x, y, tone = tones.ink) => {
  pen.font = "12px system-ui, sans-serif";
  pen.lineWidth = 3;
  pen.strokeStyle = tones.paper;
  pen.strokeText(text, x, y);
  pen.fillStyle = tone;
  pen.fillText(text, x, y);
};
/* A name stands at the first of some places that is free, and is left out where there is none. */
const BESIDE = [[8, -7], [8, 15], [-8, -7], [-8, 15], [14, 4], [-14, 4]];
const spotOf = name => spots.find(each => each.name === name && each.isSingle) ?? spots.find(each => each.name === name);
const labels = note => {
  const taken = [], places = film.names ? spots.filter(each => each.isSingle).map(({name, at}) => [name, ...project(at)]) : [];
  const isFree = (box, name) => taken.every(each => box[2] < each[0] || box[0] > each[2] || box[3] < each[1] || box[1] > each[3])
    && places.every(([other, x, y]) => other === name || x < box[0] || x > box[2] || y < box[1] || y > box[3]);
  pen.font = "12px system-ui, sans-serif";
  if (film.names) for (const name of new Set(spots.map(each => each.name))) {
    const [x, y] = project(spotOf(name).at), wide = pen.measureText(name).width;
    const boxes = BESIDE.map(([right, down]) => { const left = right > 0 ? x + right : x + right - wide; return [left, y + down - 11, left + wide, y + down + 2]; });
    const box = boxes.find(each => isFree(each, name) && each[0] > 0 && each[2] < width && each[1] > 0 && each[3] < height);
    if (!box) continue;
    taken.push(box);
    words(name, box[0], box[3] - 2);
  }
  const scales = film.layers.flatMap(layer => layer.arrows);
  if (scales.length) {
    const long = film.arrow * scale, text = "force " + shortly(scales[0].scale * (scales[0].factor || 1)) + " " + (scales[0].unit || "N");
    pen.beginPath();
    trace([[12, height - 12], [12 + long, height - 12]]);
    stroke(tones.force, 2.4);
    words(text, 12, height - 18, tones.force);
  }
  if (film.layers.length > 1) film.layers.forEach((layer, i) => words(layer.label, 12, 18 + 16 * i, [tones.line, tones.second, tones.accent][i % 3]));
  const spot = view.chosen && spotOf(view.chosen);
  if (spot) ring(spot.at, note);
};
const ring = (at, note = "") => {
  const [x, y] = project(at);
  pen.beginPath();
  pen.arc(x, y, 13, 0, 2 * Math.PI);
  stroke(tones.accent, 2);
  words(note, x + 16, y + 5, tones.accent);
};

const thread = (at, [x, y]) => {        // from a point to one of the screen
  const [a, b] = project(at);
  pen.beginPath();
  trace([[a, b], [x, y]]);
  pen.setLineDash([4, 4]);
  stroke(tones.accent, 1.5);
  pen.setLineDash([]);
};
const turnBy = (x, y) => { view.turn -= x; view.tilt = Math.min(Math.max(view.tilt + y, -1.5), 1.5); changed(); };
const zoomBy = factor => { view.zoom = Math.min(Math.max(view.zoom * factor, 0.2), 20); changed(); };
const mark = name => { const spot = spotOf(name); if (spot) ring(spot.at); };
const cursor = (at, note, isSnapped) => {
  const [x, y] = project(at);
  pen.beginPath();
  pen.arc(x, y, isSnapped ? 10 : 5, 0, 2 * Math.PI);
  stroke(isSnapped ? tones.accent : tones.force, isSnapped ? 3 : 1.5);
  pen.font = "12px system-ui, sans-serif";
  words(note, Math.max(Math.min(x + 14, width - pen.measureText(note).width - 6), 4), y + 26 > height - 4 ? y - 12 : y + 26, tones.force);
};
readColours();
return {view, begin, mark, cursor, words, tones, fit, frame, draw, ring, thread, project, unproject, place, turnBy, zoomBy, sub, cross, length, get spots() { return spots; }, get scale() { return scale; }};
};

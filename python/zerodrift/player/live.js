// A mechanism that is simulated while it is shown: sliders change its parameters and inputs, and a point that is dragged takes it along.
// Stands after core.js and picture.js, whose functions it uses, in one module.

const scene = JSON.parse(document.getElementById("live").textContent);
const canvas = document.getElementById("picture"), AXES = ["x", "y", "z"].slice(0, scene.dimension);
const words = {play: document.getElementById("play"), state: document.getElementById("state"), told: document.getElementById("told")};
const BUDGET = 8;           // ms of computation in a picture
const live = {mechanism: null, playing: !matchMedia("(prefers-reduced-motion: reduce)").matches, dragged: null, turned: null, owed: 0, cost: 0, pictures: 0,
  times: [], chosen: null, initial: null, sliders: []};
globalThis.zerodrift = {live, scene, read, time, poses, parameter, setParameter, setInput, input, save, violation, energyViolation, freedoms};

const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

async function unpacked(bytes) {
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

// ---- points: bodies carry them; parameters move them in their bodies ----

const layer = {shapes: scene.shapes, at: [], fixed: scene.fixed, paths: [], arrows: [], loads: []};
scene.layers = [layer];
const picture = pictureOf(scene, canvas, () => {});

function locate() {
  const pose = poses(live.mechanism), size = scene.dimension === 3 ? 12 : 3;
  layer.at = scene.points.map(([body, isDirection, ...own]) => {
    const at = pose.subarray(size * (body - 1), size * body), cosine = Math.cos(at[2]), sine = Math.sin(at[2]);
    const turned = size === 12 ? AXES.map((_, k) => at[3 + k] * own[0] + at[6 + k] * own[1] + at[9 + k] * own[2])
      : [cosine * own[0] - sine * own[1], sine * own[0] + cosine * own[1]];
    return isDirection ? turned : turned.map((x, k) => x + at[k]);
  });
}

function reshape() {
  const {effects, products, names} = scene.changes, value = names.map((name) => parameter(live.mechanism, name));
  for (const shape of scene.shapes) {
    const length = names.indexOf(`${shape[1]}.length`);
    if (shape[0] === "rod" && shape[3] && length >= 0) shape[3] = value[length];      // of a rod that may be released
  }
  for (let i = 0; i < effects.length; i += 3) {
    let sum = 0;
    for (let k = 7 * effects[i + 1]; k < 7 * (effects[i + 1] + effects[i + 2]); k += 7)
      sum += products[k] * [1, 3, 5].reduce((all, j) => all * value[products[k + j]] ** products[k + j + 1], 1);
    scene.points[Math.floor(effects[i] / scene.dimension)][2 + effects[i] % scene.dimension] = sum;
  }
}

// The view grows with the motion; what goes far is followed.
function look() {
  if (scene.follow) return;
  const places = layer.at.filter((_, i) => !scene.points[i][1]), room = 0.1 * picture.length(picture.sub(scene.high, scene.low));
  let grown = false;
  for (const k of AXES.keys()) {
    const low = Math.min(...places.map((at) => at[k])), high = Math.max(...places.map((at) => at[k]));
    if (low < scene.low[k]) [scene.low[k], grown] = [low - room, true];
    if (high > scene.high[k]) [scene.high[k], grown] = [high + room, true];
  }
  if (grown) picture.frame();
}

// Forces as arrows, to the scale of the largest one so far.
function pushForces() {
  const forces = scene.arrows.map((name) => [...read(live.mechanism, `${name}.force`)]);
  live.force = Math.max(0.99 * (live.force ?? 0), 1e-9, ...forces.map(picture.length));
  forces.forEach((force, i) => {
    Object.assign(layer.arrows[i], {scale: live.force, to: layer.at.length});
    layer.at.push(force.map((x) => x / live.force));
  });
}

function draw() {
  locate();
  look();
  pushForces();
  layer.paths = ways.map((each) => each.values);
  picture.draw();
  if (live.chosen) picture.ring(layer.at[live.chosen.point], live.chosen.name);
  if (live.dragged) picture.thread(layer.at[live.dragged.point], live.dragged.screen);
}

function tell() {
  const m = live.mechanism, {freedoms: count, redundant} = freedoms(m), extra = redundant.length ? ` · redundant: ${redundant.join(", ")}` : "";
  words.state.textContent = `t = ${time(m).toFixed(2)} s · freedom ${count}${extra}`;
}

// ---- the last seconds: violation and energy error on a logarithmic scale, graphs, and ways of points ----

const LONGEST = 600;        // pictures that lines reach back
const line = (name, unit, measured) => ({name, unit, measured, values: []});
const trust = [line("position violation", "m", violation), line("energy error", "J", (m) => Math.abs(energyViolation(m)))];
const graphs = scene.graphs.map(({name, unit, factor, measure, part}) => line(name, unit, (m) => factor * read(m, measure)[part]));
const ways = scene.paths.map((name) => line(name, "m", (m) => [...read(m, name)]));
const drawnOn = [[document.getElementById("trust"), trust, true]];
for (const unit of new Set(graphs.map((each) => each.unit))) {
  const own = graphs.filter((each) => each.unit === unit), element = document.createElement("canvas");
  element.setAttribute("role", "img");
  element.setAttribute("aria-label", `Graphs of ${own.map((each) => each.name).join(", ")}`);
  document.getElementById("graphs").append(element);
  drawnOn.push([element, own, false]);
}
Object.assign(live, {trust, graphs});

function keep() {
  const m = live.mechanism;
  if (time(m) === live.times.at(-1)) return;
  live.times.push(time(m));
  for (const each of [live, ...trust, ...graphs, ...ways]) {
    if (each !== live) each.values.push(each.measured(m));
    const kept = each === live ? each.times : each.values;
    if (kept.length > LONGEST) kept.shift();
  }
}

function drawGraphs() {
  const to = time(live.mechanism), from = live.times[0] ?? to;
  for (const [element, lines, log] of drawnOn) graph(element, picture, lines, {from, to, times: live.times, log});
}

// ---- time ----

function fail(error) {
  words.told.textContent = error.message;
}

function next(now) {
  const begin = performance.now(), elapsed = Math.min((now - (live.last ?? now)) / 1000, 0.05) * scene.speed;
  live.last = now;
  try {
    if (live.playing || (live.dragged && !assembles())) {
      const tug = live.dragged ? springOf(live.dragged) : () => {};
      live.owed = Math.min(live.owed + elapsed, 0.05 * scene.speed + scene.step);
      for (; live.owed >= scene.step / 2 && performance.now() - begin < BUDGET; live.owed -= scene.step) {
        tug();
        step(live.mechanism, 1);
      }
    } else if (live.dragged) pull(live.mechanism, () => whereIs(live.dragged.point), targetOf(live.dragged));
    keep();
    draw();
    drawGraphs();
    tell();
  } catch (error) {
    live.playing = false;
    words.play.textContent = "Play";
    fail(error);
  }
  live.cost = performance.now() - begin;
  live.pictures++;
  requestAnimationFrame(next);
}

// ---- pulling: a spring from the pointer while time goes on, assembly while it stands; in space parallel to the screen ----

const MOST = 30;            // coordinates of a mechanism that is assembled within a picture; of larger ones time goes on while they are pulled
const assembles = () => positions(live.mechanism).length <= MOST;
const HELD = 1e-9;          // mobility of a point, relative to that of a free body, below which the constraints hold it
const whereIs = (point) => { locate(); return layer.at[point]; };
const targetOf = ({screen, depth}) => picture.unproject(screen, depth);

function setForce(force) {
  AXES.forEach((axis, k) => setInput(live.mechanism, `grip.force.${axis}`, force[k]));
}

// Moves the grip to a point. Returns the sum of its accelerations along the axes for forces of 1 N, in 1/kg: 0 where the constraints hold it.
function grip(point) {
  const m = live.mechanism, [body, , ...own] = scene.points[point], unit = scene.mass;
  AXES.forEach((axis) => setParameter(m, `grip.${axis}`, 0));
  setParameter(m, "grip.body", body);
  AXES.forEach((axis, k) => setParameter(m, `grip.${axis}`, own[k]));
  const accelerations = [null, ...AXES.keys()].map((along) => {
    setForce(AXES.map((_, k) => (k === along ? unit : 0)));
    restore(m, save(m));
    return read(m, "grip.acceleration");
  });
  release();
  return AXES.reduce((sum, _, k) => sum + (accelerations[k + 1][k] - accelerations[0][k]) / unit, 0);
}

function release() {
  const m = live.mechanism;
  setForce(AXES.map(() => 0));
  restore(m, save(m));
}

// Begins to pull at a point: a spring as stiff as four oscillations a second of the picture, and as the weight of the mechanism needs, but not too
// stiff for the steps; its damping is that of the point alone.
function hold(point, screen) {
  let mobility = 0;
  try {
    mobility = grip(point);
  } catch (error) {
    return fail(error);
  }
  const h = scene.step;
  if (!(mobility * scene.mass > HELD)) {
    return fail(new Error("This point cannot be pulled: a motor whose motion is given, or the constraints, hold it."));
  }
  const wanted = Math.max((8 * Math.PI / scene.speed) ** 2 / mobility, scene.weight / (0.05 * picture.length(picture.sub(scene.high, scene.low))));
  const stiffness = Math.min(wanted, (0.3 / h) ** 2 / mobility), damping = Math.min(1.4 * Math.sqrt(stiffness / mobility), 0.5 / (h * mobility));
  live.dragged = {point, screen, depth: picture.project(whereIs(point))[2], stiffness, damping};
  words.told.textContent = "";
}

// A function that sets the spring's force for the next step.
function springOf(dragged) {
  const target = targetOf(dragged);
  return () => {
    const at = whereIs(dragged.point), before = dragged.before ?? at;
    dragged.before = at;
    setForce(at.map((x, k) => dragged.stiffness * (target[k] - x) - dragged.damping * (x - before[k]) / scene.step));
  };
}

function letGo() {
  if (live.dragged) release();
  live.dragged = live.turned = null;
}

// ---- hands ----

const REACH = 25, PULL = 40;        // points of the screen: from a point that is grasped, and that an arrow key pulls
const onScreen = (event) => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
const parts = scene.shapes.map(([, name, numbers]) => ({name, point: numbers.findLast((i) => i >= 0 && !scene.points[i][1])}))
  .filter((part) => part.name && part.point !== undefined)
  .filter((part, i, all) => all.findIndex((each) => each.name === part.name) === i);
const placeOf = (name) => parts.find((part) => part.name === name)?.point ?? scene.shapes.find((shape) => shape[1] === name)?.[2][0];       // of the ground, too

function play(on) {
  live.playing = on;
  words.play.textContent = on ? "Pause" : "Play";
}

function toggle() {
  play(!live.playing);
  words.told.textContent = "";
}

function restart() {
  restoreRun(live.mechanism, live.initial);
  live.times = [];
  for (const each of [...trust, ...graphs, ...ways]) each.values = [];
  live.dragged = null;
  words.told.textContent = "";
  reshape();
  live.sliders.forEach((show) => show());
}

function nearest([x, y]) {
  const far = (i) => { const [a, b] = picture.project(layer.at[i]); return Math.hypot(a - x, b - y); };
  const known = [...layer.at.keys()].filter((i) => !scene.points[i][1]).map((i) => [far(i), i]).sort((a, b) => a[0] - b[0])[0];
  return known && known[0] < REACH ? known[1] : null;
}

function onKey(event) {
  const way = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
  if (event.key === " " && [document.body, canvas].includes(event.target)) toggle();
  else if (event.target !== canvas) return;
  else if (event.key === "n") live.chosen = parts[(parts.indexOf(live.chosen) + 1) % parts.length];
  else if (event.key === "+" || event.key === "-") picture.zoomBy(event.key === "+" ? 1.2 : 1 / 1.2);
  else if (way && event.shiftKey && scene.dimension === 3) picture.turnBy(-way[0] / 15, -way[1] / 15);
  else if (way && live.chosen) {
    const [x, y] = picture.project(layer.at[live.chosen.point]), screen = [x + PULL * way[0], y + PULL * way[1]];
    if (live.dragged) live.dragged.screen = screen;
    else if (!event.repeat) hold(live.chosen.point, screen);
  } else return;
  event.preventDefault();
}

function listen() {
  canvas.addEventListener("pointerdown", (event) => {
    const at = onScreen(event), point = nearest(at);
    if (point !== null) hold(point, at);
    else if (scene.dimension === 3) live.turned = at;
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    const at = onScreen(event);
    if (live.dragged) live.dragged.screen = at;
    else if (live.turned) {
      picture.turnBy((at[0] - live.turned[0]) / 150, (at[1] - live.turned[1]) / 150);
      live.turned = at;
    }
  });
  canvas.addEventListener("touchstart", (event) => { if (nearest(onScreen(event.touches[0])) !== null || scene.dimension === 3) event.preventDefault(); },
    {passive: false});          // elsewhere a finger scrolls the page around it
  for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, letGo);
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    picture.zoomBy(Math.exp(-event.deltaY / 300));
  }, {passive: false});
  words.play.addEventListener("click", toggle);
  document.getElementById("restart").addEventListener("click", restart);
  addEventListener("keydown", onKey);
  addEventListener("keyup", (event) => { if (event.key.startsWith("Arrow")) letGo(); });
}

function addSlider({name, kind, least, most, value, unit: unitOf, factor}) {
  const label = document.createElement("label"), slider = document.createElement("input"), shown = document.createElement("output");
  const [set, get] = kind === "input" ? [setInput, input] : [setParameter, parameter];
  Object.assign(slider, {type: "range", min: least, max: most, step: (most - least) / 200, value});
  slider.setAttribute("aria-label", name);
  const show = () => {
    slider.value = get(live.mechanism, name);
    shown.textContent = `${(get(live.mechanism, name) * factor).toPrecision(4)} ${unitOf}`;
  };
  slider.addEventListener("input", () => {
    const wanted = Math.min(most, Math.max(least, +slider.value));
    try {
      set(live.mechanism, name, wanted);
      words.told.textContent = "";
    } catch (error) {
      fail(new Error(`${name} cannot be ${(wanted * factor).toPrecision(4)} ${unitOf}: ${error.message}`));
    }
    show();
    reshape();
    for (const each of ways) each.values = [];      // paths of another mechanism
  });
  show();
  live.sliders.push(show);
  label.append(name, slider, shown);
  document.getElementById("sliders").append(label);
}

layer.arrows = scene.arrows.map((name) => ({name, at: placeOf(name), ...scene.force}));
Object.assign(globalThis.zerodrift, {parts, spot: (point) => picture.project(layer.at[point]), at: (point) => { locate(); return picture.place(layer, point); }});
const packed = scene.core ?? globalThis.zerodriftCore;
play(live.playing);
if (packed) {
  live.mechanism = create(await load(await unpacked(bytesOf(packed))), bytesOf(scene.block), scene.t);
  live.initial = saveRun(live.mechanism);
  scene.sliders.forEach(addSlider);
  listen();
  requestAnimationFrame(next);
} else fail(new Error("the core is missing: the site must be built with the package ziglang"));

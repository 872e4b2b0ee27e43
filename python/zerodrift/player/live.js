// A mechanism that is simulated while it is shown: sliders change its parameters and inputs, and a point that is dragged takes it along.
// Stands behind core.js, whose functions it uses, in one module.

const scene = JSON.parse(document.getElementById("live").textContent);
const canvas = document.getElementById("picture"), pen = canvas.getContext("2d");
const words = {play: document.getElementById("play"), state: document.getElementById("state"), told: document.getElementById("told")};
const BUDGET = 8;           // ms of computation in a picture
const live = {mechanism: null, playing: !matchMedia("(prefers-reduced-motion: reduce)").matches, dragged: null, cost: 0, pictures: 0, trust: [], chosen: null};
live.place = (point) => { const box = canvas.getBoundingClientRect(), [x, y] = onScreen(point); return [x + box.left, y + box.top]; };
globalThis.zerodrift = {live, read, time, setParameter, setInput, save, violation, energyViolation, freedoms};

const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

async function unpacked(bytes) {
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

// ---- view: the rectangle of the drawing in m, and its scale ----

let frame = {x: 0, y: 0, scale: 1};
const placeOf = (point) => (typeof point === "string" ? read(live.mechanism, point) : point);
const onScreen = ([x, y]) => [(x - frame.x) * frame.scale, (frame.y - y) * frame.scale];
const inDrawing = (event) => {
  const box = canvas.getBoundingClientRect();
  return [(event.clientX - box.left) / frame.scale + frame.x, frame.y - (event.clientY - box.top) / frame.scale];
};

function fit() {
  const box = canvas.getBoundingClientRect(), ratio = devicePixelRatio || 1;
  canvas.width = box.width * ratio;
  canvas.height = box.height * ratio;
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  const [left, low, right, high] = scene.extent;
  frame.scale = Math.min(box.width / (right - left), box.height / (high - low));
  frame.x = (left + right) / 2 - box.width / 2 / frame.scale;
  frame.y = (low + high) / 2 + box.height / 2 / frame.scale;
}

// ---- drawing ----

function line(points, width, colour) {
  pen.beginPath();
  points.forEach((point, i) => (i ? pen.lineTo(...point) : pen.moveTo(...point)));
  if (points.length > 2) pen.closePath();
  Object.assign(pen, {lineWidth: width, strokeStyle: colour, fillStyle: colour, lineCap: "round", lineJoin: "round"});
  pen.stroke();
  if (points.length > 2) { pen.globalAlpha = 0.25; pen.fill(); pen.globalAlpha = 1; }
}

function spring(a, b, colour) {
  const dx = b[0] - a[0], dy = b[1] - a[1], size = Math.hypot(dx, dy) || 1, turns = 8;
  const points = [a, b];
  for (let i = 1; i < 2 * turns; i++) {
    const along = 0.15 + 0.7 * i / (2 * turns), across = (i % 2 ? 6 : -6) / size;
    points.splice(-1, 0, [a[0] + along * dx - across * dy, a[1] + along * dy + across * dx]);
  }
  pen.beginPath();
  points.forEach((point, i) => (i ? pen.lineTo(...point) : pen.moveTo(...point)));
  Object.assign(pen, {lineWidth: 1.5, strokeStyle: colour});
  pen.stroke();
}

// The view grows with the motion; a mechanism that nothing joins to the ground is followed.
function look() {
  const places = pointNames().map(placeOf), [left, low, right, high] = scene.extent, isFree = !scene.pins.some((pin) => pin.ground);
  const [a, b] = [0, 1].map((k) => Math.min(...places.map((at) => at[k]))), [c, d] = [0, 1].map((k) => Math.max(...places.map((at) => at[k])));
  if (!places.length || (a >= left && b >= low && c <= right && d <= high)) return;
  const x = (a + c - left - right) / 2, y = (b + d - low - high) / 2, room = 0.1 * (right - left);
  scene.extent = isFree ? [left + x, low + y, right + x, high + y]
    : [a < left ? a - room : left, b < low ? b - room : low, c > right ? c + room : right, d > high ? d + room : high];
  fit();
}

function draw() {
  look();
  const ink = getComputedStyle(document.body).color, box = canvas.getBoundingClientRect();
  pen.clearRect(0, 0, box.width, box.height);
  scene.bodies.forEach((body, i) => {
    const points = body.points.map(placeOf).map(onScreen), colour = `hsl(${(i * 137.5 + 210) % 360} 55% 50%)`;
    if (points.length > 1) return line(points, 7, colour);
    pen.fillStyle = colour;
    for (const [x, y] of points) pen.fillRect(x - 16, y - 10, 32, 20);
  });
  if (live.chosen) {
    const [x, y] = onScreen(placeOf(live.chosen));
    pen.beginPath();
    pen.arc(x, y, 13, 0, 7);
    Object.assign(pen, {strokeStyle: ink, lineWidth: 2});
    pen.stroke();
  }
  for (const [a, b] of scene.springs) spring(onScreen(placeOf(a)), onScreen(placeOf(b)), ink);
  for (const pin of scene.pins) {
    const [x, y] = onScreen(placeOf(pin.at));
    pen.beginPath();
    if (pin.ground) { pen.moveTo(x, y); pen.lineTo(x - 9, y + 14); pen.lineTo(x + 9, y + 14); pen.closePath(); }
    Object.assign(pen, {fillStyle: "white", strokeStyle: ink, lineWidth: 1.5});
    pen.stroke();
    pen.beginPath();
    pen.arc(x, y, 4, 0, 7);
    pen.fill();
    pen.stroke();
  }
}

function tell() {
  const m = live.mechanism, {freedoms: count, redundant} = freedoms(m), extra = redundant.length ? ` · redundant: ${redundant.join(", ")}` : "";
  words.state.textContent = `t = ${time(m).toFixed(2)} s · degrees of freedom ${count}${extra}`;
}

// ---- trust: position violation and energy error of the last seconds, on logarithmic scales as in a film ----

const TRUST = [["position violation", "m", violation, "#0072b2", "#56b4e9"], ["energy error", "J", (m) => Math.abs(energyViolation(m)), "#b34a00", "#ffb57d"]];
const LONGEST = 600, LEAST = 1e-18;        // pictures that the lines reach back, and the smallest number that they show

function keepTrust() {
  TRUST.forEach(([, , measured], i) => {
    const values = (live.trust[i] ??= []);
    values.push(measured(live.mechanism));
    if (values.length > LONGEST) values.shift();
  });
}

function drawTrust() {
  const strip = document.getElementById("trust"), brush = strip.getContext("2d"), ratio = devicePixelRatio || 1, {width, height} = strip.getBoundingClientRect();
  const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
  if (strip.width !== Math.round(width * ratio)) [strip.width, strip.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  brush.setTransform(ratio, 0, 0, ratio, 0, 0);
  brush.clearRect(0, 0, width, height);
  brush.font = "11px system-ui, sans-serif";
  TRUST.forEach(([name, unit, , light, dark], i) => {
    const values = live.trust[i] ?? [], known = values.filter(Number.isFinite);
    if (!known.length) return;
    const heights = values.map((x) => Math.log10(Math.max(x, LEAST))), low = Math.min(...heights.filter(Number.isFinite)), high = Math.max(...heights.filter(Number.isFinite), low + 1);
    brush.beginPath();
    heights.forEach((x, k) => brush[k ? "lineTo" : "moveTo"](8 + (width - 16) * k / (LONGEST - 1), height - 4 - (height - 20) * (x - low) / (high - low)));
    Object.assign(brush, {strokeStyle: isDark ? dark : light, fillStyle: isDark ? dark : light, lineWidth: 1.5});
    brush.stroke();
    brush.fillText(`${name} \u2264 ${Math.max(...known).toExponential(1)} ${unit}`, 8 + i * Math.max(190, width / 2), 11);
  });
}

// ---- time ----

function fail(error) {
  words.told.textContent = error.message;
}

function next(now) {
  const begin = performance.now(), elapsed = Math.min((now - (live.last ?? now)) / 1000, 0.05) * scene.speed;
  live.last = now;
  try {
    if (live.dragged) pull(live.mechanism, live.dragged.name, live.dragged.target);
    else if (live.playing) {
      const goal = time(live.mechanism) + elapsed;
      while (time(live.mechanism) < goal - scene.step / 2 && performance.now() - begin < BUDGET) step(live.mechanism, 1);
    }
    keepTrust();
    draw();
    drawTrust();
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

// ---- hands ----

function toggle() {
  live.playing = !live.playing;
  words.play.textContent = live.playing ? "Pause" : "Play";
  words.told.textContent = "";
}

const pointNames = () => [...new Set(scene.bodies.flatMap((body) => body.points).filter((point) => typeof point === "string"))];

function nearest(event) {
  const [x, y] = inDrawing(event), reach = 25 / frame.scale, names = pointNames();
  const far = (name) => { const [a, b] = placeOf(name); return Math.hypot(a - x, b - y); };
  const name = names.sort((a, b) => far(a) - far(b))[0];
  return name && far(name) < reach ? name : null;
}

const PULL = 40;        // points of the screen that an arrow key pulls

function onKey(event) {
  const names = pointNames(), way = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
  if (event.key === " " && [document.body, canvas].includes(event.target)) toggle();
  else if (event.target !== canvas) return;
  else if (event.key === "n") live.chosen = names[(names.indexOf(live.chosen) + 1) % names.length];
  else if (way && live.chosen) live.dragged = {name: live.chosen, target: placeOf(live.chosen).map((x, k) => x + way[k] * PULL / frame.scale)};
  else return;
  event.preventDefault();
}

function listen() {
  canvas.addEventListener("pointerdown", (event) => {
    const name = nearest(event);
    if (!name) return;
    live.dragged = {name, target: inDrawing(event)};
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => { if (live.dragged) live.dragged.target = inDrawing(event); });
  for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, () => { live.dragged = null; });
  words.play.addEventListener("click", toggle);
  addEventListener("keydown", onKey);
  addEventListener("keyup", (event) => { if (event.key.startsWith("Arrow")) live.dragged = null; });
  addEventListener("resize", fit);
}

function addSlider({name, kind, least, most, value}) {
  const label = document.createElement("label"), slider = document.createElement("input"), shown = document.createElement("output");
  Object.assign(slider, {type: "range", min: least, max: most, step: (most - least) / 200, value});
  slider.setAttribute("aria-label", name);
  shown.textContent = value.toPrecision(4);
  slider.addEventListener("input", () => {
    const set = kind === "input" ? setInput : setParameter, m = live.mechanism;
    try {
      set(m, name, Math.min(most, Math.max(least, +slider.value)));
      words.told.textContent = "";
    } catch (error) {
      slider.value = (kind === "input" ? input : parameter)(m, name);
      fail(new Error(`${name} cannot be ${(+slider.value).toPrecision(4)}: ${error.message}`));
    }
    shown.textContent = (kind === "input" ? input : parameter)(m, name).toPrecision(4);
  });
  label.append(name, slider, shown);
  document.getElementById("sliders").append(label);
}

const packed = scene.core ?? globalThis.zerodriftCore;
words.play.textContent = live.playing ? "Pause" : "Play";
if (packed) {
  live.mechanism = create(await load(await unpacked(bytesOf(packed))), bytesOf(scene.block), scene.t);
  scene.sliders.forEach(addSlider);
  listen();
  fit();
  requestAnimationFrame(next);
} else fail(new Error("the core is missing: the site must be built with the package ziglang"));

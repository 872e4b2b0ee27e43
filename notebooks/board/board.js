// The drawing board: tools, hands and keys, the panel of the chosen part, and the mechanism in motion.
// The core counts and simulates; the mechanism is in the address of the page.

import {close, create, freedoms, load, positions, pull, read, step, time, unit, violation} from "../core.js";
import {addressOf, angleOf, bodyOf, checkedModel, drawnPlace, elementNamed, emptyModel, isJoint, lengthOf, modelOfAddress, ofKind, parsedModel} from "./model.js";
import {blockOf} from "./block.js";
import {addLink, addMotor, addPin, addSlot, addSpring, copyOf, moveTo, partsAt, remove, takePoses, targetAt} from "./edit.js";
import {fitView, gridOf, paint, painterOf, placesOf, readTones} from "./picture.js";
import {fieldsOf} from "./fields.js";
import {pythonOf} from "./python.js";

const TOOLS = {
  move: ["Move", "v", "Drag a pin or an end. Press a part to see its numbers; press again for the next one there."],
  link: ["Link", "l", "Press where it begins and where it ends. On another link it is pinned there."],
  pin: ["Pin to ground", "g", "Press an end or a point of a link."],
  slot: ["Slot", "o", "Press an end of a link: it then slides along a line of the ground, whose angle can be typed."],
  motor: ["Motor", "m", "Press a pin or a slot."],
  spring: ["Spring", "s", "Press its two ends, on links or on the ground."],
  remove: ["Remove", "x", "Press what is to go."],
};
const BUDGET = 8, REACH = 16, TOUCH = 26, STEP = 1e-3, MAX_UNDO = 100;       // ms of computation in a picture; points of the screen; s
const byId = (id) => document.getElementById(id);
const canvas = byId("board"), painter = painterOf(canvas);
const board = {model: emptyModel(), core: null, mechanism: null, tool: "link", chosen: null, pending: null, cursor: null, held: null, isPlaying: false,
               moved: false, history: [], reach: REACH, pictures: 0, cost: 0};
globalThis.zerodrift = {board, painter, addressOf, blockOf, positions, pythonOf, read, time, violation, freedoms};

function tell(sentence) {
  byId("told").textContent = sentence;
}

// ---- the mechanism of the core ----

// The drawing as the core assembles it; what cannot close or move stays as drawn, with the core's sentence.
function assemble() {
  if (board.mechanism) close(board.mechanism);
  board.mechanism = null;
  board.moved = board.isPlaying = false;
  if (!ofKind(board.model, "link").length) return;
  board.mechanism = create(board.core, blockOf(board.model, STEP), 0, true);
}

function tryToAssemble() {
  try {
    assemble();
    tell("");
  } catch (error) {
    tell(sentenceOf(error));
  }
  show();
}

const sentenceOf = (error) => error.message.replace(/\s*\[zd:[\w-]+\]$/, "").replace(/^./, (letter) => letter.toUpperCase());

// Takes a change of the drawing into the history and the address. With `mustClose` it is undone where it cannot close.
function change(edit, {mustClose = false} = {}) {
  const before = JSON.stringify(board.model);
  try {
    edit(board.model);
    board.model = checkedModel(board.model);
    if (mustClose) {
      assemble();
      if (board.mechanism) takePoses(board.model, positions(board.mechanism));
    }
  } catch (error) {
    board.model = JSON.parse(before);
    tryToAssemble();
    tell(sentenceOf(error));
    return false;
  }
  remember(before);
  tryToAssemble();
  return true;
}

function remember(before) {
  board.history.push(before);
  if (board.history.length > MAX_UNDO) board.history.shift();
  history.replaceState(null, "", addressOf(board.model));
}

function undo() {
  const before = board.history.pop();
  if (!before) return tell("There is nothing to undo");
  board.model = JSON.parse(before);
  history.replaceState(null, "", addressOf(board.model));
  return tryToAssemble();
}

function open(read, what) {
  try {
    board.model = read();
  } catch (error) {
    return tell(`${what} is refused: ${error.message}`);
  }
  Object.assign(board, {history: [], chosen: null, pending: null});
  fitView(canvas, painter, board.model);
  return tryToAssemble();
}

// ---- what is shown beside the picture ----

const digits = (value) => (Math.abs(value) < 1e-9 ? "0" : Math.abs(value) >= 1e5 || Math.abs(value) < 1e-3 ? value.toExponential(2) : value.toPrecision(4));

function showCount() {
  const m = board.mechanism;
  if (!m) return (byId("count").textContent = ofKind(board.model, "link").length ? "The drawing does not move as it is." : "Draw a link to begin.");
  const {freedoms: count, rank, redundant} = freedoms(m);
  const extra = redundant.length ? `\nredundant: ${redundant.join(", ")}` : "";
  return (byId("count").textContent = `degrees of freedom ${count}\nrank of the constraints ${rank} of ${m.constraints.length}${extra}
t = ${time(m).toFixed(2)} s, position violation ${violation(m).toExponential(1)} m`);
}

function showReactions() {
  const body = byId("reactions"), m = board.mechanism, rows = m ? m.measures.filter((name) => !name.endsWith(".power")) : [];
  if (body.rows.length !== rows.length) body.replaceChildren(...rows.map(() => { const row = document.createElement("tr"); row.append(document.createElement("th"), document.createElement("td")); row.firstChild.scope = "row"; return row; }));
  rows.forEach((name, i) => {
    let text = "not defined here";
    try {
      text = `${[...read(m, name)].map(digits).join(", ")} ${unit(m, name)}`;
    } catch { /* a singular pose */ }
    body.rows[i].cells[0].textContent = name;
    body.rows[i].cells[1].textContent = text;
  });
}

function showParts() {
  const parts = byId("parts"), names = ["", ...board.model.elements.map(({name}) => name)];
  if (!names.includes(board.chosen)) board.chosen = null;
  parts.replaceChildren(...names.map((name) => new Option(name ? `${name} (${elementNamed(board.model, name).kind})` : "gravity", name, false, name === (board.chosen ?? ""))));
  byId("values").replaceChildren(...fieldsOf(board.model, board.chosen).map(fieldElement));
}

function fieldElement({label, value, choices, set, mustClose}) {
  const row = document.createElement("label"), field = document.createElement(choices ? "select" : "input");
  row.className = "field";
  if (choices) field.append(...choices.map((each) => new Option(each, each, false, each === value)));
  else Object.assign(field, {value, type: "text", inputMode: typeof value === "number" ? "decimal" : "text"});
  field.addEventListener("change", () => {
    const typed = field.value.slice(0, 40), given = typeof value === "number" ? Number(typed.replace(",", ".")) : typed;
    const renamed = label === "name" ? given : board.chosen, before = board.chosen;
    board.chosen = renamed;
    if (change((model) => set(model, given), {mustClose})) return;
    board.chosen = before;
    const told = byId("told").textContent;
    showParts();
    tell(`${label} cannot be ${typed}: ${told}`);
  });
  row.append(label, field);
  return row;
}

function show() {
  showParts();
  showCount();
  showReactions();
  byId("python").textContent = pythonOf(board.model);
  byId("play").textContent = board.isPlaying ? "Pause" : "Play";
  byId("reset").disabled = !board.moved;
  for (const button of byId("tools").children) button.setAttribute("aria-pressed", String(button.dataset.tool === board.tool));
  byId("hint").textContent = board.moved ? "In motion: drag an end to pull the mechanism along. “Back to the drawing” edits again." : TOOLS[board.tool][2];
}

// ---- presses: by a mouse, a finger, or Enter at the cross ----

const pressed = {
  move(target, at) {
    const names = partsAt(board.model, at, board.reach / painter.view.scale);
    board.chosen = names[(names.indexOf(board.chosen) + 1) % Math.max(names.length, 1)] ?? null;
    show();
  },
  link: (target) => between(target, (model, from, to) => { board.chosen = addLink(model, from, to).name; }),
  spring: (target) => between(target, (model, from, to) => { board.chosen = addSpring(model, from, to).name; }),
  pin: (target) => onLink(target, (model, side, at) => addPin(model, null, side, at)),
  slot: (target) => onLink(target, addSlot),
  motor(target, at) {
    const joint = partsAt(board.model, at, board.reach / painter.view.scale).map((name) => elementNamed(board.model, name))
      .filter((element) => isJoint(element) && element.kind !== "weld").sort((a, b) => (bodyOf(b.first) === "ground") - (bodyOf(a.first) === "ground"))[0];
    if (!joint) return tell("A motor must be at a pin, a slot or a slider");
    return change((model) => { board.chosen = addMotor(model, joint).name; });
  },
  remove(target, at) {
    const name = partsAt(board.model, at, board.reach / painter.view.scale)[0];
    return name ? change((model) => remove(model, name)) : tell("There is nothing to remove here");
  },
};

function between(target, make) {
  const from = board.pending;
  if (!from) {
    board.pending = copyOf(target);
    return null;
  }
  if (Math.hypot(target.at[0] - from.at[0], target.at[1] - from.at[1]) < 2 / painter.view.scale) return null;
  board.pending = null;
  if (from.side && target.side && bodyOf(from.side) === bodyOf(target.side)) return tell("Its two ends must be on different bodies");
  return change((model) => make(model, from, copyOf(target)));
}

function onLink(target, make) {
  if (!target.side || bodyOf(target.side) === "ground") return tell("Press an end or a point of a link");
  const has = board.model.elements.some((element) => isJoint(element) && element.first.body === "ground" && JSON.stringify(element.second) === JSON.stringify(target.side));
  if (has) return tell("This point is joined to the ground already");
  return change((model) => { board.chosen = make(model, copyOf(target).side, target.at).name; });
}

const targetOf = (at) => targetAt(board.model, at, board.reach / painter.view.scale, gridOf(painter));

function press(at) {
  if (board.moved) return tell("Go back to the drawing to change it");
  tell("");
  pressed[board.tool](targetOf(at), at);
  return null;
}

// ---- pointers ----

const placeOf = (event) => { const box = canvas.getBoundingClientRect(); return painter.toDrawing([event.clientX - box.left, event.clientY - box.top]); };

function grip(at) {
  const sides = ofKind(board.model, "link").flatMap(({name}) => [`${name}.start`, `${name}.end`]), placed = placesOf(board.model, board.moved ? positions(board.mechanism) : null);
  const far = (side) => { const [x, y] = placed(side); return Math.hypot(x - at[0], y - at[1]); };
  const side = sides.sort((a, b) => far(a) - far(b))[0];
  return side && far(side) < board.reach / painter.view.scale ? side : null;
}

function down(event) {
  board.reach = event.pointerType === "touch" ? TOUCH : REACH;
  const at = placeOf(event);
  canvas.setPointerCapture(event.pointerId);
  board.cursor = at;
  board.held = {from: at, side: board.moved || board.tool === "move" ? grip(at) : null, before: JSON.stringify(board.model), isDragged: false, pan: [event.clientX, event.clientY]};
  if (!board.moved && board.tool !== "move") press(at);
}

function move(event) {
  const at = placeOf(event), {held} = board;
  board.cursor = at;
  if (!held) return;
  if (Math.hypot(at[0] - held.from[0], at[1] - held.from[1]) * painter.view.scale > 5) held.isDragged = true;
  if (!held.isDragged) return;
  if (held.side && board.moved) held.target = at;
  else if (held.side) drag(held.side, at);
  else if (board.moved || board.tool === "move") panBy(held, event);
}

function panBy(held, event) {
  painter.view.x -= (event.clientX - held.pan[0]) / painter.view.scale;
  painter.view.y += (event.clientY - held.pan[1]) / painter.view.scale;
  held.pan = [event.clientX, event.clientY];
}

// The end snaps to the grid; the mechanism follows in the same picture.
function drag(side, at) {
  const grid = gridOf(painter), before = JSON.stringify(board.model);
  try {
    moveTo(board.model, side, at.map((each) => +(Math.round(each / grid) * grid).toFixed(6)));
    board.model = checkedModel(board.model);
  } catch {
    board.model = JSON.parse(before);
  }
  tryToAssemble();
}

function up(event) {
  const {held} = board;
  board.held = null;
  if (!held) return;
  if (board.tool === "move" && !held.isDragged && !board.moved) press(placeOf(event));
  else if (held.isDragged && held.side && !board.moved) remember(held.before);
  else if (held.isDragged && board.pending && !board.moved) press(placeOf(event));
}

function zoomBy(factor, [x, y] = painter.toDrawing([canvas.clientWidth / 2, canvas.clientHeight / 2])) {
  const {view} = painter, scale = Math.min(Math.max(view.scale * factor, 1), 20000), ratio = view.scale / scale;
  Object.assign(view, {x: x + (view.x - x) * ratio, y: y + (view.y - y) * ratio, scale});
}

// ---- keys ----

function moveCursor(key, event) {
  const grid = gridOf(painter) * (event.shiftKey ? 5 : 1), [dx, dy] = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[key];
  const at = board.cursor ?? painter.toDrawing([canvas.clientWidth / 2, canvas.clientHeight / 2]);
  board.cursor = [at[0] + dx * grid, at[1] + dy * grid].map((each) => Math.round(each / grid) * grid);
  if (event.altKey && board.tool === "move" && !board.moved) carry(at);
  byId("hint").textContent = `cross at ${board.cursor.map(digits).join(", ")} m`;
}

// Alt with an arrow key takes the end at the cross along.
function carry(from) {
  const side = grip(from), before = JSON.stringify(board.model);
  if (!side) return;
  drag(side, board.cursor);
  remember(before);
}

function onKey(event) {
  const {key} = event, isTyping = event.target.matches("input, select, textarea");
  if (event.ctrlKey && key === "z" && !isTyping) { undo(); return event.preventDefault(); }
  if (isTyping || event.ctrlKey || event.metaKey) return null;
  const tool = Object.keys(TOOLS).find((name) => TOOLS[name][1] === key);
  if (tool) chooseTool(tool);
  else if (key === "p" || (key === " " && event.target === canvas)) toggle();
  else if (key === "+" || key === "-") zoomBy(key === "+" ? 1.2 : 1 / 1.2);
  else if (key === "Escape") { board.pending = null; tell(""); }
  else if (key === "Delete" && board.chosen && !board.moved) change((model) => remove(model, board.chosen));
  else if (event.target === canvas && key.startsWith("Arrow")) moveCursor(key, event);
  else if (event.target === canvas && key === "Enter" && board.cursor) press(board.cursor);
  else return null;
  return event.preventDefault();
}

function chooseTool(tool) {
  board.tool = tool;
  board.pending = null;
  tell("");
  show();
}

// ---- time ----

function toggle() {
  if (!board.mechanism) return tell(byId("told").textContent || "Draw a link to begin");
  board.isPlaying = !board.isPlaying;
  board.moved ||= board.isPlaying;
  board.pending = null;
  tell("");
  return show();
}

function advanceBy(seconds, begin) {
  const m = board.mechanism, goal = time(m) + seconds;
  if (board.held?.target && board.held.side) {
    const [name, end] = board.held.side.split("."), index = ofKind(board.model, "link").findIndex((link) => link.name === name);
    return pullEnd(m, index, end, board.held.target);
  }
  while (board.isPlaying && time(m) < goal - STEP / 2 && performance.now() - begin < BUDGET) step(m, 1);
  return null;
}

// Pulls an end of a link, which has no measure, by its coordinates.
function pullEnd(m, index, end, target) {
  const link = ofKind(board.model, "link")[index], side = `${link.name}.${end}`;
  return pull(m, () => placesOf(board.model, positions(m))(side), target);
}

function picture(now) {
  const begin = performance.now(), elapsed = Math.min((now - (board.last ?? now)) / 1000, 0.05);
  board.last = now;
  if (board.moved && board.mechanism) {
    try {
      advanceBy(elapsed, begin);
      showCount();
      if (board.pictures % 6 === 0) showReactions();
    } catch (error) {
      board.isPlaying = false;
      show();
      tell(sentenceOf(error));
    }
  }
  paint(canvas, painter, board.model, {p: board.moved && board.mechanism ? positions(board.mechanism) : null, chosen: board.chosen, pending: board.pending,
                                       cursor: board.cursor && board.pending ? targetOf(board.cursor).at : board.cursor, isEdited: !board.moved});
  board.cost = performance.now() - begin;
  board.pictures++;
  requestAnimationFrame(picture);
}

// ---- begin ----

function saveFile() {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([JSON.stringify(board.model, null, 1)], {type: "application/json"}));
  link.download = `${board.model.name}.json`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

async function copyText(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    byId("hint").textContent = `${what} is copied`;
  } catch {
    tell(`${what} cannot be copied by this browser: take it from ${what === "The address" ? "the address bar" : "the text above"}`);
  }
}

function listen() {
  for (const [name, [label, key]] of Object.entries(TOOLS)) {
    const button = document.createElement("button");
    Object.assign(button, {type: "button", textContent: label, title: `key ${key}`});
    button.dataset.tool = name;
    button.setAttribute("aria-keyshortcuts", key);
    button.addEventListener("click", () => chooseTool(name));
    byId("tools").append(button);
  }
  canvas.addEventListener("pointerdown", down);
  canvas.addEventListener("pointermove", move);
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", () => { board.held = null; });
  canvas.addEventListener("wheel", (event) => { event.preventDefault(); zoomBy(Math.exp(-event.deltaY / 400), placeOf(event)); }, {passive: false});
  document.addEventListener("keydown", onKey);
  addEventListener("hashchange", () => open(() => modelOfAddress(location.hash), "The address"));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => readTones(canvas));
  for (const [id, act] of Object.entries({play: toggle, reset: tryToAssemble, undo, fit: () => fitView(canvas, painter, board.model), save: saveFile,
    copy: () => copyText(pythonOf(board.model), "The Python text"), link: () => copyText(location.href, "The address")})) byId(id).addEventListener("click", act);
  byId("parts").addEventListener("change", (event) => { board.chosen = event.target.value || null; show(); });
  byId("values").addEventListener("submit", (event) => event.preventDefault());
  byId("file").addEventListener("change", async ({target}) => {
    const [file] = target.files;
    if (file) { const text = file.size > 1e6 ? " ".repeat(1e6) : await file.text(); open(() => parsedModel(text), "The file"); }
    target.value = "";
  });
}

async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

readTones(canvas);
listen();
if (globalThis.zerodriftCore) board.core = await load(await unpacked(globalThis.zerodriftCore));
else tell("The core is missing: the site must be built with the package ziglang");
if (location.hash.startsWith("#m=")) open(() => modelOfAddress(location.hash), "The address");
else fitView(canvas, painter, board.model);
show();
requestAnimationFrame(picture);

// The drawing board: tools, hands and keys, the panel of the chosen part, and the mechanism in motion.
// The core counts and simulates; the mechanism is in the address of the page. Pictures and graphs are those of the player.

import {close, create, freedoms, load, positions, pull, read, step, time, unit, violation} from "../core.js";
import {addressOf, angleOf, bodyOf, checkedModel, drawnPlace, elementNamed, emptyModel, isJoint, lengthOf, modelOfAddress, ofKind, parsedModel, swingOf} from "./model.js";
import {blockOf} from "./block.js";
import {addBlock, addLink, addLoad, addMotor, addPin, addPoint, addSlot, addSpring, copyOf, moveTo, endsOf, partsAt, remove, takePoses, targetAt} from "./edit.js";
import {looseOf, movesOf, placesOf, shapesOf, sidesOf, stretchedOf} from "./scene.js";
import {fieldsOf} from "./fields.js";
import {pythonOf} from "./python.js";

const TOOLS = {
  move: ["Move", "v", "Drag a pin or an end. Press a part to see its numbers; press again for the next one there."],
  link: ["Link", "l", "Press one end, then the other. An end on another link is pinned to it."],
  pin: ["Pin to ground", "g", "Press an end or a point of a link."],
  slot: ["Slot", "o", "Press an end of a link: it then slides along a line of the ground, whose angle can be typed."],
  block: ["Block", "b", "Press a place, or an end of a link: a block with mass slides along a line of the ground."],
  point: ["Point", "t", "Press a link, then where the point is: beside the link it makes a plate of it. Its path over a turn is drawn."],
  load: ["Load", "f", "Press an end or a point of a link: a force acts there, whose components can be typed."],
  motor: ["Motor", "m", "Press a pin or a slot."],
  spring: ["Spring", "s", "Press its two ends, on links or on the ground."],
  remove: ["Remove", "x", "Press the part to remove; what depends on it goes, too."],
};
const BUDGET = 8, PIN = 6.5, REACH = 16, TOUCH = 26, STEP = 1e-3, MAX_UNDO = 100;       // ms of computation in a picture; points of the screen; s
const EXAMPLES = /*examples*/[];
const byId = (id) => document.getElementById(id);
const canvas = byId("board"), layer = {shapes: [], at: [], fixed: [], paths: [], arrows: [], loads: []};
const film = {name: "board", dimension: 2, low: [-1, -0.5], high: [1, 0.5], follow: 0, pin: 0.03, arrow: 1, names: true, layers: [layer]};
const picture = pictureOf(film, canvas, () => {});
const board = {model: emptyModel(), core: null, mechanism: null, tool: "link", chosen: null, pending: null, cursor: null, held: null, isPlaying: false,
               moved: false, history: [], future: [], reach: REACH, pictures: 0, cost: 0, turn: null, stretched: [], fingers: new Map(), shown: null,
               isStill: false, reason: ""};
const painter = {toScreen: (at) => picture.project(at).slice(0, 2), toDrawing: (at) => picture.unproject(at, 0), show};
globalThis.zerodrift = {board, painter, film, addressOf, blockOf, positions, pythonOf, read, time, violation, freedoms, table};

// ---- view ----

// Shows all between two corners.
function show(low, high) {
  Object.assign(film, {low, high});
  Object.assign(picture.view, {zoom: 1, shift: [0, 0]});
  picture.frame();
  picture.begin();
}

// The view shows all of a drawing and of its motion over a turn, with room around it.
function fitView() {
  const sides = board.model.elements.flatMap(sidesOf).concat(endsOf(board.model, 0)), poses = turnOf().poses.filter((_, i) => i % 10 === 0);
  const places = [null, ...poses].flatMap((p) => sides.map(placesOf(board.model, p)));
  const [low, high] = places.length ? [Math.min, Math.max].map((limit) => [0, 1].map((k) => limit(...places.map((at) => at[k])))) : [[-1, -0.5], [1, 1]];
  const room = 0.35 * Math.max(high[0] - low[0], high[1] - low[1], 0.1);
  show(low.map((x) => x - room), high.map((x) => x + room));
}

const reachOf = () => board.reach / picture.scale;

// 1, 2 or 5 times a power of ten metres, at least 14 points on the screen.
function gridOf() {
  const least = 14 / picture.scale, power = 10 ** Math.floor(Math.log10(least));
  return power * [1, 2, 5, 10].find((each) => each * power >= least * 0.999);
}

film.under = (line, tones) => {
  const step = 5 * gridOf(), {width, height} = canvas.getBoundingClientRect(), [[left, top], [right, low]] = [[0, 0], [width, height]].map(painter.toDrawing);
  for (let i = Math.ceil(left / step); i * step < right; i++) line([[i * step, low], [i * step, top]], tones.body, i ? 0.6 : 1.4);
  for (let i = Math.ceil(low / step); i * step < top; i++) line([[left, i * step], [right, i * step]], tones.body, i ? 0.6 : 1.4);
};

function tell(sentence) {
  byId("told").textContent = sentence;
}

// ---- the mechanism of the core ----

// The drawing as the core assembles it; what cannot close or move stays as drawn, with the core's sentence.
function assemble() {
  if (board.mechanism) close(board.mechanism);
  board.mechanism = null;
  board.moved = board.isPlaying = false;
  board.stretched = [];
  if (!ofKind(board.model, "link").length) return;
  board.mechanism = create(board.core, blockOf(board.model, STEP), 0, true);
}

function tryToAssemble() {
  Object.assign(board, {shown: null, isStill: false, reason: "the drawing does not close"});
  try {
    assemble();
    tell("");
  } catch (error) {
    tell(sentenceOf(error));
  }
  board.turn = null;
  refresh();
}

// The core's sentence in words of a drawing: a motor that the links stop, or loops that do not close.
function sentenceOf(error) {
  const motors = ofKind(board.model, "motor").filter((each) => each.drives === "speed").map(({name}) => name), row = /in row \d+ '([^'.]+)/.exec(error.message)?.[1];
  if (/violates the constraints/.test(error.message) && motors.length && closes({...board.model, elements: board.model.elements.filter(({name}) => !motors.includes(name))})) {
    board.reason = "its links hold each other";
    return `${motors.join(", ")} cannot turn: the links hold each other${row && !motors.includes(row) ? `, most at ${row}` : ""}`;
  }
  return /position correction/.test(error.message) ? "The loops cannot close with these lengths" : plainSentence(error);
}

function closes(model) {
  try {
    close(create(board.core, blockOf(model, STEP), 0, true));
    return true;
  } catch { return false; }
}

const plainSentence = (error) => error.message.replace(/\s*\[zd:[\w-]+\]$/, "").replace(/^./, (letter) => letter.toUpperCase());

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
  board.future = [];
  board.history.push(before);
  if (board.history.length > MAX_UNDO) board.history.shift();
  history.replaceState(null, "", addressOf(board.model));
}

function undo(from = board.history, to = board.future, word = "undo") {
  const other = from.pop();
  if (!other) return tell(`There is nothing to ${word}`);
  to.push(JSON.stringify(board.model));
  board.model = JSON.parse(other);
  history.replaceState(null, "", addressOf(board.model));
  return tryToAssemble();
}

const redo = () => undo(board.future, board.history, "redo");

function open(read, what) {
  try {
    board.model = read();
  } catch (error) {
    return tell(`${what} is refused: ${error.message}`);
  }
  Object.assign(board, {history: [], future: [], chosen: null, pending: null, tool: "move"});
  history.replaceState(null, "", addressOf(board.model));
  tryToAssemble();
  recordTurn();
  return fitView();
}

// An empty board, from which undo leads back.
function empty() {
  change((model) => { Object.assign(model, emptyModel()); });
  board.chosen = null;
  chooseTool("link");
}

// ---- what is shown beside the picture ----

const digits = (value) => (Math.abs(value) < 1e-9 ? "0" : Math.abs(value) >= 1e5 || Math.abs(value) < 1e-3 ? value.toExponential(2) : value.toPrecision(4));

function showCount() {
  const m = board.mechanism, loose = looseOf(board.model), nothing = `nothing joins ${loose.join(", ")} to the ground`;
  if (!m) return (byId("count").textContent = ofKind(board.model, "link").length ? `moves: no, ${board.reason}` : "Draw a link to begin, or open one of these:");
  const {freedoms: count, rank, redundant} = freedoms(m);
  const lines = [movesOf(board.model, count), ...(loose.length ? [nothing] : []), ...(redundant.length ? [`redundant: ${redundant.join(", ")}`] : []),
                 `t = ${time(m).toFixed(2)} s, position violation ${violation(m).toExponential(1)} m; rank of the constraints ${rank} of ${m.constraints.length}`];
  return (byId("count").textContent = lines.join("\n"));
}

// Torque of a pin that has neither a motor nor damping.
function isIdle(name) {
  const [of, what] = name.split("."), element = elementNamed(board.model, of);
  return what === "torque" && element?.kind === "revolute" && !element.damping && !ofKind(board.model, "motor").some(({joint}) => joint === of);
}

// Name of a force with the body on which a joint exerts it.
function onBody(name) {
  const [of, what] = name.split("."), element = elementNamed(board.model, of);
  return what === "force" && element && isJoint(element) ? `${name} on ${bodyOf(element.second)}` : name;
}

function showReactions() {
  const body = byId("reactions"), m = board.mechanism, rows = m ? m.measures.filter((name) => !name.endsWith(".power") && !isIdle(name)) : [];
  if (body.rows.length !== rows.length) body.replaceChildren(...rows.map(() => { const row = document.createElement("tr"); row.append(document.createElement("th"), document.createElement("td")); row.firstChild.scope = "row"; return row; }));
  rows.forEach((name, i) => {
    let text = "not defined here";
    try {
      text = `${[...read(m, name)].map(digits).join(", ")} ${unit(m, name)}`;
    } catch { /* a singular pose */ }
    body.rows[i].cells[0].textContent = onBody(name);
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
    const typed = field.value.slice(0, 40), given = typeof value === "number" ? (typed.trim() ? Number(typed.replace(",", ".")) : NaN) : typed;
    const renamed = label === "name" ? given : board.chosen, before = board.chosen;
    board.chosen = renamed;
    const number = [...byId("values").querySelectorAll("input, select")].indexOf(field);
    if (change((model) => set(model, given), {mustClose})) {
      const again = byId("values").querySelectorAll("input, select")[number];        // the next number can be typed
      again?.focus();
      return again?.select?.();
    }
    board.chosen = before;
    const told = byId("told").textContent;
    showParts();
    tell(`${label} cannot be ${typed.trim() || "empty"}: ${told}`);
  });
  row.append(label, field);
  return row;
}

function refresh() {
  showParts();
  showCount();
  showReactions();
  byId("examples").hidden = board.model.elements.length > 0;
  byId("redo").disabled = !board.future.length;
  byId("undo").disabled = !board.history.length;
  byId("python").textContent = pythonOf(board.model);
  byId("play").textContent = board.isPlaying ? "Pause" : "Play";
  byId("reset").disabled = !board.moved;
  for (const button of byId("tools").children) button.setAttribute("aria-pressed", String(button.dataset.tool === board.tool));
  byId("hint").textContent = board.moved ? `In motion: ${ofKind(board.model, "motor").some(({drives}) => drives === "speed") ? "a motor sets its speed; one that sets a torque lets you pull" : "drag an end to pull the mechanism along"}. Press a part to see its forces.` : TOOLS[board.tool][2];
}

// ---- presses: by a mouse, a finger, or Enter at the cross ----

const pressed = {
  move(target, at) {
    const names = partsAt(board.model, at, reachOf(), placesOf(board.model, board.moved ? positions(board.mechanism) : null));
    board.chosen = names[(names.indexOf(board.chosen) + 1) % Math.max(names.length, 1)] ?? null;
    refresh();
  },
  link: (target) => between(target, (model, from, to) => { board.chosen = addLink(model, from, to).name; }),
  spring: (target) => between(target, (model, from, to) => { board.chosen = addSpring(model, from, to).name; }),
  pin: (target) => onLink(target, (model, side, at) => addPin(model, null, side, at)),
  slot: (target) => onLink(target, addSlot),
  load: (target) => (target.side && bodyOf(target.side) !== "ground" ? change((model) => { board.chosen = addLoad(model, copyOf(target).side).name; })
    : tell("No end or point of a link is here")),
  block: (target) => change((model) => { board.chosen = addBlock(model, copyOf(target), 0.02 * gridOf()).name; }),
  point(target, at) {
    const from = board.pending;
    if (!from && (!target.side || bodyOf(target.side) === "ground")) return tell("No link is here");
    if (!from) { board.pending = copyOf(target); return null; }
    board.pending = null;
    const place = Math.hypot(at[0] - from.at[0], at[1] - from.at[1]) < reachOf() ? from.at : target.at;
    return change((model) => { board.chosen = addPoint(model, bodyOf(from.side), place).name; });
  },
  motor(target, at) {
    const joint = partsAt(board.model, at, reachOf()).map((name) => elementNamed(board.model, name))
      .filter((element) => isJoint(element) && element.kind !== "weld").sort((a, b) => (bodyOf(b.first) === "ground") - (bodyOf(a.first) === "ground"))[0];
    if (!joint) return tell("A motor must be at a pin, a slot or a slider");
    return change((model) => { board.chosen = addMotor(model, joint).name; });
  },
  remove(target, at) {
    const name = partsAt(board.model, at, reachOf())[0];
    return name ? change((model) => remove(model, name)) : tell("There is nothing to remove here");
  },
};

function between(target, make) {
  const from = board.pending;
  if (!from) {
    board.pending = copyOf(target);
    return null;
  }
  if (Math.hypot(target.at[0] - from.at[0], target.at[1] - from.at[1]) < 2 / picture.scale) return null;
  board.pending = null;
  if (from.side && target.side && bodyOf(from.side) === bodyOf(target.side)) return tell("Its two ends must be on different bodies");
  return change((model) => make(model, from, copyOf(target)));
}

function onLink(target, make) {
  if (!target.side || bodyOf(target.side) === "ground") return tell("No end or point of a link is here");
  const has = board.model.elements.some((element) => isJoint(element) && element.first.body === "ground" && JSON.stringify(element.second) === JSON.stringify(target.side));
  if (has) return tell("This point is joined to the ground already");
  return change((model) => { board.chosen = make(model, copyOf(target).side, target.at).name; });
}

const targetOf = (at) => targetAt(board.model, at, reachOf(), gridOf());

function press(at) {
  if (board.moved) return pressed.move(null, at);
  tell("");
  pressed[board.tool](targetOf(at), at);
  return null;
}

// ---- pointers ----

const onScreen = (event) => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
const placeOf = (event) => painter.toDrawing(onScreen(event));

function grip(at) {
  const sides = endsOf(board.model, reachOf()), placed = placesOf(board.model, board.moved ? positions(board.mechanism) : null);
  const far = (side) => { const [x, y] = placed(side); return Math.hypot(x - at[0], y - at[1]); };
  const side = sides.sort((a, b) => far(a) - far(b))[0];
  return side && far(side) < reachOf() ? side : null;
}

function down(event) {
  board.reach = event.pointerType === "touch" ? TOUCH : REACH;
  const at = placeOf(event);
  board.fingers.set(event.pointerId, onScreen(event));
  if (board.fingers.size > 1) { board.held = board.pending = null; return; }
  canvas.setPointerCapture(event.pointerId);
  board.cursor = at;
  board.held = {from: at, side: board.moved || board.tool === "move" ? grip(at) : null, before: JSON.stringify(board.model), isDragged: false, pan: [event.clientX, event.clientY]};
  if (!board.moved && board.tool !== "move") press(at);
}

function move(event) {
  const at = placeOf(event), {held} = board;
  board.cursor = at;
  if (board.fingers.size > 1) { pinch(event); return; }
  if (!held) return;
  if (Math.hypot(at[0] - held.from[0], at[1] - held.from[1]) * picture.scale > 5) held.isDragged = true;
  if (!held.isDragged) return;
  if (held.side && board.moved) held.target = at;
  else if (held.side) drag(held.side, at);
  else if (board.moved || board.tool === "move") panBy(held, event);
}

// Two fingers zoom about the place between them, and move it.
function pinch(event) {
  const measured = () => { const [a, b] = [...board.fingers.values()]; return [Math.hypot(a[0] - b[0], a[1] - b[1]) || 1, [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]]; };
  if (!board.fingers.has(event.pointerId)) return;
  const [before, from] = measured();
  board.fingers.set(event.pointerId, onScreen(event));
  const [after, to] = measured();
  picture.view.shift = picture.view.shift.map((each, k) => each + to[k] - from[k]);
  zoomBy(after / before, to);
}

function panBy(held, event) {
  picture.view.shift = picture.view.shift.map((each, k) => each + [event.clientX, event.clientY][k] - held.pan[k]);
  held.pan = [event.clientX, event.clientY];
}

// The end snaps to the grid; the mechanism follows in the same picture.
function drag(side, at) {
  const grid = gridOf(), before = JSON.stringify(board.model);
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
  board.fingers.delete(event.pointerId);
  if (event.pointerType === "touch") board.cursor = null;
  if (!held) return;
  if ((board.tool === "move" || board.moved) && !held.isDragged) press(placeOf(event));
  else if (held.isDragged && held.side && !board.moved) remember(held.before);
  else if (held.isDragged && board.pending && !board.moved) press(placeOf(event));
}

// What is at a place of the screen stays there.
function zoomBy(factor, screen = [canvas.clientWidth / 2, canvas.clientHeight / 2]) {
  const {view} = picture, wanted = Math.min(Math.max(factor, 1 / picture.scale), 20000 / picture.scale), middle = [canvas.clientWidth / 2, canvas.clientHeight / 2];
  view.shift = view.shift.map((each, k) => screen[k] - middle[k] + (each - screen[k] + middle[k]) * wanted);
  view.zoom *= wanted;
  picture.begin();
}

// ---- keys ----

function moveCursor(key, event) {
  const grid = gridOf() * (event.shiftKey ? 5 : 1), [dx, dy] = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[key];
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
  if (event.ctrlKey && ["z", "y", "Z"].includes(key) && !isTyping) { if (key === "z") undo(); else redo(); return event.preventDefault(); }
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
  if (board.moved && tool !== "move") return tryToAssemble();
  tell("");
  return refresh();
}

// ---- time ----

function toggle() {
  if (!board.mechanism) return tell(byId("told").textContent || "Draw a link to begin");
  board.isPlaying = !board.isPlaying;
  board.moved ||= board.isPlaying;
  Object.assign(board, {shown: null, isStill: false});
  board.pending = null;
  tell("");
  return refresh();
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

// A crank that goes no further: the place, and the links that lie in one line there.
function lockedAt(error, m = board.mechanism) {
  const [motor] = ofKind(board.model, "motor").filter((each) => each.drives === "speed"), p = m && positions(m);
  const lines = m ? stretchedOf(board.model, p) : [], turned = motor && elementNamed(board.model, motor.joint);
  if (!motor || !lines.length || turned.axis) return plainSentence(error);
  if (m === board.mechanism) board.stretched = [...new Set(lines.flat())];
  const crank = ofKind(board.model, "link").findIndex((link) => link.name === bodyOf(turned.second));
  return `${motor.name} can turn ${bodyOf(turned.second)} no further than ${Math.round(p[3 * crank + 2] * 180 / Math.PI)}°: ${lines.map((pair) => pair.join(" and ")).join(", ")} lie in one line there. `
    + "With a shorter crank it may turn fully.";
}

// ---- over a turn: paths of points, and graphs of the chosen part ----

const SAMPLES = 360, FREE = 2;      // of a turn; s, where no motor has a speed
const NOTHING = {to: FREE, lines: [], paths: [], poses: [], told: ""}, turnOf = () => board.turn ?? NOTHING, linesOf = (name) => turnOf().lines.filter((line) => line.of === name || line.body === name);

// One turn or swing of the first motor with a speed, otherwise two seconds, by a mechanism of its own: as far as it gets.
function recordTurn() {
  const motor = ofKind(board.model, "motor").find((each) => each.drives === "speed" && each.law), turn = {to: FREE, lines: [], paths: [], poses: [], told: "", isTurn: false}, swing = motor && swingOf(motor);
  board.turn = turn;
  if (!board.mechanism) return;
  if (swing) turn.to = 2 * Math.PI / swing.w;
  else if (motor && !elementNamed(board.model, motor.joint).axis) [turn.to, turn.isTurn] = [2 * Math.PI / Math.abs(motor.law), true];
  const count = Math.max(1, Math.ceil(turn.to / SAMPLES / STEP)), step1 = turn.to / SAMPLES / count;
  let m = null;
  const points = ofKind(board.model, "point"), add = (of, name, unitOf, measured) => turn.lines.push({of, name, unit: unitOf, measured, values: []});
  try {
    m = create(board.core, blockOf(board.model, step1), 0, true);
    const at = (point) => placesOf(board.model, positions(m))(point);
    for (const point of points) ["x", "y"].forEach((axis, k) => add(point.name, `${point.name}.position.${axis}`, "m", () => at(point)[k]));
    for (const name of m.measures) {
      const size = read(m, name).length, of = name.replace(/\.[^.]*$/, "");
      for (let k = 0; k < size; k++) add(of, size > 1 ? `${name}.${"xy"[k]}` : name, unit(m, name), () => read(m, name)[k]);
    }
    for (const joint of ofKind(board.model, "slot", "prismatic")) {
      const owner = ofKind(board.model, "link").findIndex(({name}) => name === bodyOf(joint.first)), away = () => [at(joint.first), at(joint.second)];
      add(joint.name, `${joint.name}.displacement`, "m", () => {
        const [[a, b], [x, y]] = away(), turn = owner < 0 ? 0 : positions(m)[3 * owner + 2], [c, s] = [Math.cos(turn), Math.sin(turn)], [u, v] = joint.axis;
        return (x - a) * (c * u - s * v) + (y - b) * (s * u + c * v);
      });
      if (owner < 0 && joint.kind === "prismatic") turn.lines.at(-1).body = bodyOf(joint.second);      // a block has no angle to be seen
    }
    const turning = ofKind(board.model, "link").map(({name}, i) => [name, i]).filter(([name]) => !turn.lines.some(({body}) => body === name));
    for (const [name, i] of turning) add(name, `${name}.angle`, "rad", () => positions(m)[3 * i + 2]);
    turn.paths = points.map(() => []);
    for (let i = 0; i <= SAMPLES; i++) {
      for (const line of turn.lines) line.values.push(line.measured());
      points.forEach((point, k) => turn.paths[k].push(at(point)));
      turn.poses.push(Array.from(positions(m)));
      if (i < SAMPLES) step(m, count);
    }
  } catch (error) {
    turn.told = `The graph ends where the motion does. ${m && turn.isTurn ? lockedAt(error, m) : ""}`;
    for (const line of turn.lines) while (line.values.length <= SAMPLES) line.values.push(NaN);
  } finally {
    if (m) close(m);
  }
  for (const line of turn.lines.filter((each) => each.name.endsWith(".y"))) addSize(turn, line);
  for (const {of, body, values} of turn.lines.filter((each) => each.name.endsWith(".displacement")))
    turn.lines.push({of, body, name: `${of}.speed`, unit: "m/s", values: values.map((_, i) => slopeOf(turn, values, i))});
}

function slopeOf(turn, values, i) {
  const [a, b] = [Math.max(i - 1, 0), Math.min(i + 1, SAMPLES)];
  return (values[b] - values[a]) / (b - a) / turn.to * SAMPLES;
}

// Speed of a point from its positions, size of a force from its components.
function addSize(turn, y) {
  const x = turn.lines.find((each) => each.name === y.name.replace(/y$/, "x")), slope = ({values}, i) => slopeOf(turn, values, i);
  const isPlace = y.unit === "m", values = y.values.map((each, i) => (isPlace ? Math.hypot(slope(x, i), slope(y, i)) : Math.hypot(x.values[i], each)));
  turn.lines.push({of: y.of, name: isPlace ? `${y.of}.speed` : y.name.replace(/\.y$/, ""), unit: isPlace ? "m/s" : y.unit, values});
}

// CSV: a line for each time, all that is known over the turn.
function table() {
  const {lines, to} = turnOf(), quoted = (text) => `"${text.replaceAll('"', '""')}"`;
  const rows = Array.from({length: SAMPLES + 1}, (_, i) => [to * i / SAMPLES, ...lines.map((line) => line.values[i])].join());
  return [["t [s]", ...lines.map((line) => `${line.name} [${line.unit}]`)].map(quoted).join(), ...rows, ""].join("\n");
}

// Lines of the chosen part: all of a unit, or one of them.
function shownLines() {
  const lines = linesOf(board.chosen), what = byId("turn-what").value, [one] = lines.filter(({name}) => name === what);
  return one ? [one] : lines.filter((line) => line.unit === lines[0].unit);
}

// Largest of the last line that is shown, the size of a vector.
function largestOf(line) {
  const sizes = line.values.map((x) => (Number.isFinite(x) ? Math.abs(x) : -1)), i = sizes.indexOf(Math.max(...sizes));
  return `Largest ${line.name}: ${digits(line.values[i])} ${line.unit} at ${digits(turnOf().to * i / SAMPLES)} s`;
}

// The place of the pointer over the graph: the mechanism is shown there, with its values.
function lookAt(event) {
  const [left, right] = byId("turn").drawn.area, share = (event.clientX - byId("turn").getBoundingClientRect().left - left) / (right - left);
  const {length} = turnOf().poses;
  if (length) board.shown = Math.min(Math.max(Math.round(share * SAMPLES), 0), length - 1);
}

function showTurn() {
  const lines = linesOf(board.chosen), {to, told, isTurn} = turnOf(), what = byId("turn-what"), names = ["", ...lines.map(({name}) => name)];
  const now = board.shown !== null ? to * board.shown / SAMPLES : board.mechanism && board.moved ? time(board.mechanism) % to : 0;
  byId("turn-title").textContent = isTurn ? "Over a turn" : `Over ${+to.toPrecision(3)} s`;
  what.parentElement.hidden = !lines.length;
  if ([...what.options].map(({value}) => value).join() !== names.join()) what.replaceChildren(...names.map((name) => new Option(name || "all of a kind", name)));
  byId("turn").hidden = !lines.length;
  byId("csv").disabled = !turnOf().lines.length;
  byId("turn-hint").textContent = lines.length ? `${told} ${largestOf(shownLines().at(-1))}`.trim() : `Choose a point, a pin, a motor or a link. ${told}`;
  if (lines.length) graph(byId("turn"), picture, shownLines(), {from: 0, to, now});
}

// ---- pictures ----

function noted(target) {
  if (!board.cursor || board.moved) return "";
  const [x, y] = target.at, from = board.pending?.at ?? board.held?.start, where = `${digits(x)}, ${digits(y)} m`;
  const on = target.side ? ` on ${bodyOf(target.side)}` : "";
  if (!from) return where + on;
  const [dx, dy] = [x - from[0], y - from[1]];
  return `${digits(Math.hypot(dx, dy))} m, ${(Math.atan2(dy, dx) * 180 / Math.PI).toFixed(1)}°${on}`;
}

function draw() {
  const p = turnOf().poses[board.shown] ?? (board.moved && board.mechanism ? positions(board.mechanism) : null), element = board.chosen && elementNamed(board.model, board.chosen);
  film.pin = PIN / picture.scale;
  film.arrow = 70 / picture.scale;
  Object.assign(layer, shapesOf(board.model, p, film.pin), {order: null, arrows: [], paths: turnOf().paths.filter((path) => path.length > 1)});
  if (element && board.mechanism?.measures.includes(`${board.chosen}.force`)) pushForce(element, placesOf(board.model, p));
  picture.view.chosen = board.chosen;
  picture.draw("");
  for (const name of board.stretched) picture.mark(name);
  picture.words(`${+(5 * gridOf()).toPrecision(2)} m a square`, canvas.clientWidth - 100, canvas.clientHeight - 8);
  if (!board.cursor || board.moved || board.shown !== null) return;
  const target = board.pending || board.tool !== "move" ? targetOf(board.cursor) : {at: board.cursor};
  if (board.pending) picture.thread(board.pending.at, painter.toScreen(target.at));
  picture.cursor(target.at, noted(target), Boolean(target.side));
}

// The force of the chosen joint, to the scale of its largest over the turn.
function pushForce(element, placed) {
  const most = Math.max(1e-9, ...linesOf(element.name).filter((line) => line.unit === "N").flatMap((line) => line.values.filter(Number.isFinite).map(Math.abs)));
  let force = [];
  const over = (axis) => linesOf(element.name).find((line) => line.name === `${element.name}.force.${axis}`)?.values[board.shown];
  try { force = board.shown === null ? [...read(board.mechanism, `${element.name}.force`)] : [over("x"), over("y")]; } catch { /* a singular pose */ }
  if (force.length !== 2 || !force.every(Number.isFinite)) return;
  const scale = Math.max(most, Math.hypot(...force));
  layer.at.push(placed(element.second), force.map((x) => x / scale));
  layer.arrows = [{name: element.name, at: layer.at.length - 2, to: layer.at.length - 1, scale}];
}

function next(now) {
  const begin = performance.now(), elapsed = Math.min((now - (board.last ?? now)) / 1000, 0.05);
  board.last = now;
  if (!board.turn && !board.held) recordTurn();
  if (board.moved && board.mechanism) {
    try {
      advanceBy(elapsed * byId("speed").value, begin);
      showCount();
      if (board.pictures % 6 === 0 || !board.isPlaying) showReactions();
    } catch (error) {
      board.isPlaying = false;
      refresh();
      tell(lockedAt(error));
    }
  }
  draw();
  showTurn();
  board.cost = performance.now() - begin;
  board.pictures++;
  requestAnimationFrame(next);
}

// ---- begin ----

function saveFile(ending, text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], {type: ending === "csv" ? "text/csv" : "application/json"}));
  link.download = `${board.model.name}.${ending}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  byId("hint").textContent = `${link.download} is saved.${ending === "json" ? ` In Python: m = zd.load("${link.download}")` : ""}`;
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
  for (const kind of ["pointercancel", "lostpointercapture"]) canvas.addEventListener(kind, (event) => { board.held = null; board.fingers.delete(event.pointerId); });
  canvas.addEventListener("pointerleave", () => { board.cursor = null; });
  byId("turn").addEventListener("pointermove", (event) => { if (!board.isStill || event.buttons) lookAt(event); });
  byId("turn").addEventListener("pointerdown", (event) => { board.isStill = true; board.isPlaying = false; lookAt(event); refresh(); });
  byId("turn").addEventListener("pointerleave", () => { if (!board.isStill) board.shown = null; });
  canvas.addEventListener("wheel", (event) => { event.preventDefault(); zoomBy(Math.exp(-event.deltaY / 400), onScreen(event)); }, {passive: false});
  document.addEventListener("keydown", onKey);
  addEventListener("hashchange", () => open(() => modelOfAddress(location.hash), "The address"));
  for (const [id, act] of Object.entries({play: toggle, reset: tryToAssemble, undo: () => undo(), redo, new: empty, fit: fitView, save: () => saveFile("json", JSON.stringify(board.model, null, 1)), csv: () => saveFile("csv", table()),
    copy: () => copyText(pythonOf(board.model), "The Python text"), link: () => copyText(location.href, "The address")})) byId(id).addEventListener("click", act);
  byId("parts").addEventListener("change", (event) => { board.chosen = event.target.value || null; refresh(); });
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

listen();
for (const [name, model] of EXAMPLES) {
  const button = document.createElement("button");
  Object.assign(button, {type: "button", textContent: name});
  button.addEventListener("click", () => { open(() => checkedModel(model), name); });
  byId("examples").append(button);
}
if (globalThis.zerodriftCore) board.core = await load(await unpacked(globalThis.zerodriftCore));
else tell("The core is missing: the site must be built with the package ziglang");
if (location.hash.startsWith("#m=")) open(() => modelOfAddress(location.hash), "The address");
else fitView();
refresh();
requestAnimationFrame(next);

// Picture of a drawing, as it is drawn or in motion, on a canvas.

import {angleOf, bodyOf, drawnPlace, elementNamed, isJoint, lengthOf, localOf, ofKind, turned} from "./model.js";

// Places of sides: as drawn, or with the poses of mass centres p of a mechanism in motion.
export function placesOf(model, p) {
  if (!p) return (side) => drawnPlace(model, side);
  const links = ofKind(model, "link");
  return (side) => {
    const number = links.findIndex((link) => link.name === bodyOf(side)), local = localOf(model, side);
    if (number < 0) return local;
    const [x, y, angle] = p.slice(3 * number, 3 * number + 3), [dx, dy] = turned(angle, [local[0] - lengthOf(links[number]) / 2, local[1]]);
    return [x + dx, y + dy];
  };
}

const TONES = {paper: "Canvas", ink: "CanvasText", body: "#4477aa", ground: "#888888", motor: "#bb5500", spring: "#228833", chosen: "#cc3311", grid: "#88888833"};

// A painter for a canvas; view: {x, y, scale} has the place of the left upper corner in m and the scale in points a metre.
export function painterOf(canvas) {
  const pen = canvas.getContext("2d"), view = {x: -2, y: 1.7, scale: 160};
  const toScreen = ([x, y]) => [(x - view.x) * view.scale, (view.y - y) * view.scale];
  const toDrawing = ([x, y]) => [x / view.scale + view.x, view.y - y / view.scale];
  const path = (points, closed = false) => {
    pen.beginPath();
    points.forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
    if (closed) pen.closePath();
  };
  const stroke = (points, colour, width, dash = []) => {
    path(points);
    pen.setLineDash(dash);
    Object.assign(pen, {strokeStyle: colour, lineWidth: width, lineCap: "round", lineJoin: "round"});
    pen.stroke();
    pen.setLineDash([]);
  };
  const ring = ([x, y], radius, face, edge, width = 1.5) => {
    pen.beginPath();
    pen.arc(x, y, radius, 0, 2 * Math.PI);
    Object.assign(pen, {fillStyle: face, strokeStyle: edge, lineWidth: width});
    pen.fill();
    pen.stroke();
  };
  return {pen, view, toScreen, toDrawing, path, stroke, ring};
}

export function fitCanvas(canvas, {pen}) {
  const ratio = devicePixelRatio || 1, {width, height} = canvas.getBoundingClientRect();
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio))
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  return [width, height];
}

// The view shows all of a drawing, with room around it.
export function fitView(canvas, {view}, model) {
  const {width, height} = canvas.getBoundingClientRect();
  const places = ofKind(model, "link").flatMap(({start, end}) => [start, end])
    .concat(model.elements.filter((element) => element.first).flatMap(({first, second}) => [drawnPlace(model, first), drawnPlace(model, second)]));
  const [low, high] = places.length ? [Math.min, Math.max].map((limit) => [0, 1].map((k) => limit(...places.map((at) => at[k])))) : [[-1, -0.5], [1, 1]];
  const size = Math.max(high[0] - low[0], high[1] - low[1], 0.1);
  view.scale = Math.min(width / (high[0] - low[0] + 0.9 * size), height / (high[1] - low[1] + 0.9 * size));
  view.x = (low[0] + high[0]) / 2 - width / 2 / view.scale;
  view.y = (low[1] + high[1]) / 2 + height / 2 / view.scale;
}

// 1, 2 or 5 times a power of ten metres, at least 14 points on the screen.
export function gridOf({view}) {
  const least = 14 / view.scale, power = 10 ** Math.floor(Math.log10(least));
  return power * [1, 2, 5, 10].find((each) => each * power >= least * 0.999);
}

function paintGrid(painter, width, height) {
  const {view, toDrawing, toScreen, stroke} = painter, step = 5 * gridOf(painter), [left, top] = toDrawing([0, 0]), [right, low] = toDrawing([width, height]);
  for (let i = Math.ceil(left / step); i * step < right; i++) stroke([[toScreen([i * step, 0])[0], 0], [toScreen([i * step, 0])[0], height]], TONES.grid, i ? 1 : 2);
  for (let i = Math.ceil(low / step); i * step < top; i++) stroke([[0, toScreen([0, i * step])[1]], [width, toScreen([0, i * step])[1]]], TONES.grid, i ? 1 : 2);
  painter.pen.fillStyle = TONES.ground;
  painter.pen.font = "12px system-ui, sans-serif";
  painter.pen.fillText(`${+step.toPrecision(1)} m a square`, 8, height - 8);
  return view;
}

function paintSpring({stroke, toScreen}, a, b, colour) {
  const [p, q] = [toScreen(a), toScreen(b)], dx = q[0] - p[0], dy = q[1] - p[1], size = Math.hypot(dx, dy) || 1, coils = 10;
  const points = Array.from({length: 2 * coils - 1}, (_, i) => {
    const along = 0.15 + 0.7 * (i + 1) / (2 * coils), across = (i % 2 ? 7 : -7) / size;
    return [p[0] + along * dx - across * dy, p[1] + along * dy + across * dx];
  });
  stroke([p, ...points, q], colour, 1.6);
}

function paintGround({path, pen, toScreen, stroke}, at) {
  const [x, y] = toScreen(at);
  path([[x, y], [x - 10, y + 16], [x + 10, y + 16]], true);
  pen.fillStyle = "#88888866";
  pen.fill();
  stroke([[x - 14, y + 16], [x + 14, y + 16]], TONES.ground, 2);
}

function paintRail({stroke, toScreen}, at, angle) {
  const [dx, dy] = turned(angle, [1, 0]), [x, y] = toScreen(at), long = 70;
  for (const side of [-8, 8]) stroke([[x - long * dx - side * dy, y + long * dy - side * dx], [x + long * dx - side * dy, y - long * dy - side * dx]], TONES.ground, 1.5, [6, 4]);
}

function paintJoint(painter, model, placed, joint, colour) {
  const at = placed(joint.second), {ring, toScreen, path, pen} = painter, onGround = joint.first.body === "ground";
  if (joint.axis) {
    const body = elementNamed(model, bodyOf(joint.first));
    paintRail(painter, onGround ? joint.first.local : at, Math.atan2(joint.axis[1], joint.axis[0]) + (body ? angleOf(body) : 0));
  } else if (onGround) paintGround(painter, at);
  if (joint.kind === "revolute" || joint.kind === "slot") return ring(toScreen(at), 5, TONES.paper, colour);
  const [x, y] = toScreen(at);
  path([[x - 6, y - 6], [x + 6, y - 6], [x + 6, y + 6], [x - 6, y + 6]], true);
  pen.fillStyle = colour;
  return pen.fill();
}

function paintMotor({pen, toScreen, stroke}, at, colour) {
  const [x, y] = toScreen(at);
  pen.beginPath();
  pen.arc(x, y, 14, -2.6, 1.2);
  Object.assign(pen, {strokeStyle: colour, lineWidth: 3});
  pen.stroke();
  stroke([[x + 11, y + 9], [x + 5, y + 13], [x + 10, y + 18]], colour, 3);
}

function paintName({pen, toScreen}, name, at, colour) {
  const [x, y] = toScreen(at);
  Object.assign(pen, {font: "12px system-ui, sans-serif", lineWidth: 3, strokeStyle: TONES.paper, fillStyle: colour});
  pen.strokeText(name, x + 9, y - 9);
  pen.fillText(name, x + 9, y - 9);
}

// system colours as the canvas takes them, in light and in dark
export function readTones(canvas) {
  const style = getComputedStyle(canvas);
  TONES.ink = style.color;
  TONES.paper = style.backgroundColor;
}

// Draws links, then springs, joints and motors, then what is begun: {p, chosen, pending, cursor, names}.
export function paint(canvas, painter, model, {p, chosen, pending, cursor, isEdited}) {
  const [width, height] = fitCanvas(canvas, painter), placed = placesOf(model, p), {toScreen, stroke, ring} = painter;
  const tone = (element, usual) => (element.name === chosen ? TONES.chosen : usual);
  paintGrid(painter, width, height);
  for (const link of ofKind(model, "link")) stroke([`${link.name}.start`, `${link.name}.end`].map((side) => toScreen(placed(side))), tone(link, TONES.body), 8);
  for (const spring of ofKind(model, "spring")) {
    paintSpring(painter, placed(spring.first), placed(spring.second), tone(spring, TONES.spring));
    for (const side of [spring.first, spring.second]) if (side.body === "ground") paintGround(painter, side.local);
  }
  for (const joint of model.elements.filter(isJoint)) paintJoint(painter, model, placed, joint, tone(joint, TONES.ink));
  for (const motor of ofKind(model, "motor")) paintMotor(painter, placed(elementNamed(model, motor.joint).second), tone(motor, TONES.motor));
  if (chosen) {
    const element = elementNamed(model, chosen), of = element?.kind === "motor" ? elementNamed(model, element.joint) : element;
    if (of) paintName(painter, chosen, of.kind === "link" ? [0, 1].map((k) => (placed(`${chosen}.start`)[k] + placed(`${chosen}.end`)[k]) / 2) : placed(of.second), TONES.chosen);
  }
  if (pending && cursor) stroke([toScreen(pending.at), toScreen(cursor)], TONES.chosen, 3, [6, 5]);
  if (cursor && isEdited) ring(toScreen(cursor), 7, "transparent", TONES.chosen, 2);
}

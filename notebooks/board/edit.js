// Changes of a drawing: parts are added, moved, renamed and removed, and what is joined to them follows.

import {sidesOf} from "./scene.js";
import {angleOf, bodyOf, drawnPlace, elementNamed, isJoint, lengthOf, ofKind, turned} from "./model.js";

const KIND_WORDS = {link: "link", revolute: "pin", weld: "weld", slot: "slot", prismatic: "slider", motor: "motor", spring: "spring", point: "P", force: "load"};
const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

export function newName(model, kind) {
  let count = 1;
  while (elementNamed(model, `${KIND_WORDS[kind] ?? kind}${count}`)) count++;
  return `${KIND_WORDS[kind] ?? kind}${count}`;
}

function add(model, element) {
  const made = {kind: element.kind, name: newName(model, element.kind), ...element};
  model.elements.push(made);
  return made;
}

const onGround = (at) => ({body: "ground", local: [...at]});

// A pin at a place; to the ground where the first side is missing.
export function addPin(model, first, second, at) {
  return add(model, {kind: "revolute", first: first ?? onGround(at), second, damping: 0, cut: false});
}

export function addSlot(model, second, at) {
  return add(model, {kind: "slot", first: onGround(at), second, axis: [1, 0]});
}

// A link between two targets, with a pin where a target is on another body.
export function addLink(model, from, to) {
  const link = add(model, {kind: "link", start: [...from.at], end: [...to.at], mass: 1});
  if (from.side) addPin(model, from.side, `${link.name}.start`);
  if (to.side) addPin(model, to.side, `${link.name}.end`);
  return link;
}

export function addMotor(model, joint) {
  return add(model, {kind: "motor", joint: joint.name, drives: "speed", law: 2});
}

export function addSpring(model, from, to) {
  const length = Math.hypot(to.at[0] - from.at[0], to.at[1] - from.at[1]);
  return add(model, {kind: "spring", first: from.side ?? onGround(from.at), second: to.side ?? onGround(to.at), stiffness: 100,
                     length: +length.toPrecision(3), damping: 1});
}

// A point of a link at a place, whose path is drawn; beside the line of the link it makes a plate of it.
export function addPoint(model, body, at) {
  const link = elementNamed(model, body), [x, y] = turned(-angleOf(link), [at[0] - link.start[0], at[1] - link.start[1]]);
  return add(model, {kind: "point", body, local: [+x.toPrecision(4), Math.abs(y) < 1e-3 * lengthOf(link) ? 0 : +y.toPrecision(4)]});
}

export function addLoad(model, side) {
  return add(model, {kind: "force", point: side, along: [0, -1], frame: "ground", value: 10});
}

// A block on a line of the ground, with its mass where it is pressed: a short link; pinned to a side where there is one, in place of its slot.
export function addBlock(model, {side, at}, size) {
  const slot = model.elements.find((each) => side && each.kind === "slot" && bodyOf(each.first) === "ground" && same(each.second, side));
  if (slot) remove(model, slot.name);
  const block = add(model, {kind: "link", name: newName(model, "block"), start: [...at], end: [at[0] + size, at[1]], mass: 1});
  if (side) addPin(model, side, `${block.name}.start`);
  return add(model, {kind: "prismatic", first: onGround(at), second: `${block.name}.start`, axis: slot?.axis ?? [1, 0], damping: 0, cut: false});
}

// Removes a part with all that needs it.
export function remove(model, name) {
  const gone = new Set([name]);
  for (const element of model.elements) {
    const needs = sidesOf(element).map(bodyOf).concat(element.joint ?? []);
    if (needs.some((each) => gone.has(each))) gone.add(element.name);
  }
  model.elements = model.elements.filter((element) => !gone.has(element.name));
}

export function rename(model, before, after) {
  const sideNamed = (side) => (bodyOf(side) !== before ? side : typeof side === "string" ? side.replace(/^[^.]*/, after) : {...side, body: after});
  for (const element of model.elements) {
    if (element.name === before) element.name = after;
    if (element.joint === before) element.joint = after;
    if (element.body === before) element.body = after;
    for (const key of ["first", "second", "point"]) if (element[key]) element[key] = sideNamed(element[key]);
  }
}

// Sides that joints hold in one place, from one of them on; those of a slider have the place that is drawn.
export function joinedSides(model, side) {
  const found = [side];
  for (let i = 0; i < found.length; i++)
    for (const joint of model.elements.filter(isJoint)) {
      const sides = [joint.first, joint.second];
      if (sides.some((each) => same(each, found[i]))) found.push(...sides.filter((each) => !found.includes(each)));
    }
  return found;
}

// The place nearest to a given one at which the sides can meet: on the line of a link where one of them is a point of it.
function allowedPlace(model, sides, at) {
  const inner = sides.find((side) => typeof side !== "string" && side.body !== "ground");
  if (!inner) return at;
  const link = elementNamed(model, inner.body), [x, y] = turned(-angleOf(link), [at[0] - link.start[0], at[1] - link.start[1]]);
  const local = inner.local[1] ? [x, y] : [Math.min(Math.max(x, 0), lengthOf(link)), 0], {local: before} = structuredClone(inner);
  for (const side of model.elements.flatMap(sidesOf)) if (side.body === inner.body && same(side.local, before)) side.local = [...local];
  for (const side of sides) if (side.body === inner.body) side.local = [...local];
  return drawnPlace(model, inner);
}

function place(model, side, at) {
  if (typeof side !== "string") {
    if (side.body === "ground") side.local = [...at];
    return;
  }
  const link = elementNamed(model, bodyOf(side)), end = side.split(".")[1];
  if (link[end][0] === at[0] && link[end][1] === at[1]) return;
  link[end] = [...at];
  delete link.length;
}

// Sides that are objects belong to one element each, so that those found by joinedSides are changed here.
export function moveTo(model, side, at) {
  const sides = joinedSides(model, side), where = allowedPlace(model, sides, at);
  sides.forEach((each) => place(model, each, where));
  followPoints(model);
}

// Links that are pinned to points of other links follow these.
function followPoints(model, rounds = 3) {
  for (let i = 0; i < rounds; i++)
    for (const joint of model.elements.filter(isJoint)) {
      const inner = [joint.first, joint.second].find((side) => typeof side !== "string" && side.body !== "ground");
      if (inner) joinedSides(model, inner).filter((side) => side !== inner).forEach((side) => place(model, side, drawnPlace(model, inner)));
    }
}

// The drawing takes the poses of mass centres p of an assembled mechanism; lengths that were typed stay.
export function takePoses(model, p) {
  ofKind(model, "link").forEach((link, i) => {
    const length = lengthOf(link), [x, y, angle] = p.slice(3 * i, 3 * i + 3), [dx, dy] = turned(angle, [length / 2, 0]);
    Object.assign(link, {start: [x - dx, y - dy], end: [x + dx, y + dy], length});
  });
  for (const joint of ofKind(model, "slot", "prismatic")) if (joint.first.body === "ground") joint.first.local = [...drawnPlace(model, joint.second)];
}

// Ends of links; of one that is shorter than can be aimed at, as a block, its start.
export const endsOf = (model, reach) => ofKind(model, "link").flatMap((link) => (lengthOf(link) < reach / 4 ? ["start"] : ["start", "end"]).map((end) => `${link.name}.${end}`));

// What is nearest to a place: an end of a link or a pin of one, then the middle of a link or a grid along it, then the grid.
export function targetAt(model, at, reach, grid) {
  const far = (place) => Math.hypot(place[0] - at[0], place[1] - at[1]);
  const sides = endsOf(model, reach).concat(model.elements.filter(isJoint).flatMap(({first, second}) => [first, second]), ofKind(model, "point").map(({body, local}) => ({body, local})));
  const points = sides.map((side) => ({side, at: drawnPlace(model, side)})).filter(({at: place}) => far(place) < reach);
  points.sort((a, b) => far(a.at) - far(b.at) || (bodyOf(a.side) === "ground") - (bodyOf(b.side) === "ground"));
  if (points.length) return points[0];
  for (const link of ofKind(model, "link")) {
    const [x, y] = turned(-angleOf(link), [at[0] - link.start[0], at[1] - link.start[1]]);
    if (Math.abs(y) > reach / 2 || x < 0 || x > lengthOf(link)) continue;
    const half = lengthOf(link) / 2, along = Math.abs(x - half) < reach / 2 ? half : Math.round(x / grid) * grid;
    const side = {body: link.name, local: [+Math.min(along, lengthOf(link)).toPrecision(6), 0]};
    return {side, at: drawnPlace(model, side)};
  }
  return {side: null, at: at.map((each) => +(Math.round(each / grid) * grid).toFixed(6))};
}

// Names of the parts at a place, joints and springs before links.
export function partsAt(model, at, reach, placed = (side) => drawnPlace(model, side)) {
  const far = (place) => Math.hypot(place[0] - at[0], place[1] - at[1]);
  const middle = ({first, second}) => [0, 1].map((k) => (placed(first)[k] + placed(second)[k]) / 2);
  const joints = model.elements.filter((element) => isJoint(element) && far(placed(element.second)) < reach);
  const motors = ofKind(model, "motor").filter((motor) => joints.some((joint) => joint.name === motor.joint));
  const springs = ofKind(model, "spring").filter((spring) => far(middle(spring)) < reach);
  const left = (a, b) => (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0]);
  const links = ofKind(model, "link").filter(({name}) => {
    const [a, b] = [placed(`${name}.start`), placed(`${name}.end`)], long = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    const along = ((b[0] - a[0]) * (at[0] - a[0]) + (b[1] - a[1]) * (at[1] - a[1])) / long;
    const corners = model.elements.flatMap(sidesOf).filter((side) => side.body === name && side.local[1]).map(placed);      // of a plate
    return (Math.abs(left(a, b)) / long < reach && along > -reach && along < long + reach)
      || corners.some((c) => [left(a, b), left(b, c), left(c, a)].every((each, i, all) => each * all[0] > 0));
  });
  const points = [...ofKind(model, "point"), ...ofKind(model, "force")].filter((element) => far(placed(element.point ?? element)) < reach);
  return [...points, ...joints, ...motors, ...springs, ...links].map(({name}) => name);
}

// A target as a new side, which no other element has.
export const copyOf = (target) => ({at: [...target.at], side: target.side && structuredClone(target.side)});

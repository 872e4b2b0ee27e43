// The block of data of a mechanism of the drawing board, word by word as `zd.block` writes it: see csrc/block/block.h.

import {angleOf, bodyOf, drawnPlace, isJoint, lengthOf, localOf, ofKind, swingOf, turned} from "./model.js";

const SECTIONS = ["gravity", "bodies", "joints", "quantities", "terms", "relations", "forces", "measures", "groups", "laws", "instructions", "results", "numbers",
                  "splines", "knots", "start", "outputs", "inputs", "settings", "methods", "names", "parameters", "effects", "products", "events",
                  "actions", "texts"];
const VERSION = 7;
// Numbers of kinds in the tables of the core.
const JOINT = {revolute: 0, prismatic: 1, weld: 2, slot: 4};
const QUANTITY = {angle: 2, along: 3, distance: 5, ground: 6};
const FORCE = {spring: 0, constant: 1};
const MEASURE = {"joint force": 3, "joint torque": 4, "force value": 6, "force power": 7, "drive": 8, "drive power": 9};
const METHODS = [[1, "schur", []], [2, "rk4", []], [3, "projection", [1e-12, 10, 1, 0, 1, 1]]], METHOD_VALUES = 16;
const COORDINATE = {revolute: "angle", prismatic: "along", slot: "along"};
const LENGTH_UNIT = {revolute: ["torque", "N m"], prismatic: ["force", "N"], slot: ["force", "N"]};

// Texts, each once; the offset of a text in bytes.
function textTable() {
  const offsets = new Map(), bytes = [];
  const offset = (text) => {
    if (!offsets.has(text)) {
      offsets.set(text, bytes.length);
      bytes.push(...new TextEncoder().encode(text), 0);
    }
    return offsets.get(text);
  };
  return {offset, bytes};
}

// Tables of the mechanism, and a function from a point to its body's number and its coordinates from the mass centre.
function tablesOf(model) {
  const links = ofKind(model, "link"), joints = model.elements.filter(isJoint);
  const number = (body) => 1 + links.findIndex((link) => link.name === body);
  const place = (side) => {
    const body = number(bodyOf(side)), [x, y] = localOf(model, side);
    return [body, body ? [x - lengthOf(links[body - 1]) / 2, y] : [x, y]];
  };
  return {model, links, joints, place, quantities: [], terms: [], relations: [], forces: [], observed: [], relationNames: [], swings: [], of: new Map()};
}

const drawnAngle = (tables, side) => { const body = tables.links[tables.place(side)[0] - 1]; return body ? angleOf(body) : 0; };

function jointEntry(tables, joint) {
  const [first, point1] = tables.place(joint.first), [second, point2] = tables.place(joint.second), axis = joint.axis ?? [1, 0];
  const [a, b] = [joint.first, joint.second].map((side) => drawnPlace(tables.model, side)), [x, y] = turned(drawnAngle(tables, joint.first), axis);
  const along = joint.axis ? (b[0] - a[0]) * x + (b[1] - a[1]) * y : 0;
  return {kind: JOINT[joint.kind], first, second, point1, point2, axis, along, across: 0,
          angle: drawnAngle(tables, joint.second) - drawnAngle(tables, joint.first), length: 0};
}

// Marker quantity of a joint's coordinate, added at first use.
function coordinateOf(tables, joint) {
  const {first, second, point1, point2, axis, along, angle} = jointEntry(tables, joint), kind = COORDINATE[joint.kind];
  if (!tables.of.has(joint.name)) {
    tables.of.set(joint.name, tables.quantities.length);
    tables.quantities.push([QUANTITY[kind], first, second, ...point1, ...point2, ...axis, kind === "angle" ? angle : along]);
  }
  return tables.of.get(joint.name);
}

function forceRow(tables, {kind, quantity, stiffness = 0, damping = 0, value = 0, joint = -1}) {
  tables.forces.push([FORCE[kind], quantity, stiffness, damping, value, -1, tables.terms.length, 0, joint]);
}

function motorRows(tables, motor) {
  const index = tables.joints.findIndex((joint) => joint.name === motor.joint), joint = tables.joints[index], quantity = coordinateOf(tables, joint);
  const [measured, unit] = LENGTH_UNIT[joint.kind], prescribes = motor.drives === "speed";
  if (prescribes) {
    const swing = swingOf(motor);
    tables.relations.push([tables.terms.length, 1, swing ? 1 : 0, swing ? tables.swings.push(swing) - 1 : -1, 0, swing ? 0 : motor.law, index]);
    tables.terms.push([quantity, 1]);
    tables.relationNames.push(motor.name);
  } else forceRow(tables, {kind: "constant", quantity, value: motor.law, joint: index});
  const row = (prescribes ? tables.relations : tables.forces).length - 1;
  tables.observed.push([`${motor.name}.${measured}`, unit, prescribes ? "drive" : "force value", row, 1, 1],
                       [`${motor.name}.power`, "W", prescribes ? "drive power" : "force power", row, 1, 1]);
}

function springRows(tables, spring) {
  const [first, point1] = tables.place(spring.first), [second, point2] = tables.place(spring.second);
  tables.quantities.push([QUANTITY.distance, first, second, ...point1, ...point2, 1, 0, spring.length]);
  forceRow(tables, {kind: "spring", quantity: tables.quantities.length - 1, stiffness: spring.stiffness, damping: spring.damping});
  tables.observed.push([`${spring.name}.force`, "N", "force value", tables.forces.length - 1, 1, -1]);
}

function loadRows(tables, load) {
  const [second, point] = tables.place(load.point);
  tables.quantities.push([QUANTITY.ground, 0, second, 0, 0, ...point, ...load.along, 0]);
  forceRow(tables, {kind: "constant", quantity: tables.quantities.length - 1, value: load.value});
  tables.observed.push([`${load.name}.force`, "N", "force value", tables.forces.length - 1, 1, 1]);
}

// Laws xdot - a cos(w t) = 0 as programs of csrc/laws/program.h, with the derivatives that a relation needs.
const SWING = [[2, 6, 3, 0], [49, 9, 1, 0], [2, 11, 4, 0], [4, 12, 0, 0], [2, 10, 5, 0], [50, 0, 0, 0]], RESULTS = [1, 2, 13, 14];
const swingSections = (swings) => ({
  laws: swings.map((_, i) => [6 * i, 6, 1, 4 * i, 4, 6 * i, 6]), instructions: swings.flatMap(() => SWING), results: swings.flatMap(() => RESULTS),
  numbers: swings.flatMap(({a, w}) => [0, 0, 1, w, a, a * w])});

// Elements kind by kind, in the order of the package; inputs of forces are numbered after the terms of all relations.
function filledTables(model) {
  const tables = tablesOf(model);
  tables.joints.forEach((joint, i) => {
    if (joint.damping) forceRow(tables, {kind: "spring", quantity: coordinateOf(tables, joint), damping: joint.damping, joint: i});
  });
  ofKind(model, "motor").forEach((motor) => motorRows(tables, motor));
  ofKind(model, "spring").forEach((spring) => springRows(tables, spring));
  ofKind(model, "force").forEach((load) => loadRows(tables, load));
  tables.forces.forEach((force) => { force[6] = tables.terms.length; });
  const reactions = tables.joints.flatMap((joint, i) => [[`${joint.name}.force`, "N", "joint force", i, 2, 1],
    ...(joint.kind === "slot" ? [] : [[`${joint.name}.torque`, "N m", "joint torque", i, 1, 1]])]);
  return {...tables, measures: [...reactions, ...tables.observed]};
}

// Mass centres and angles as drawn, x, y, angle of each link; then their rates, at rest.
export function drawnStart(model) {
  const p = ofKind(model, "link").flatMap((link) => {
    const angle = angleOf(link), [x, y] = turned(angle, [lengthOf(link) / 2, 0]);
    return [link.start[0] + x, link.start[1] + y, angle];
  });
  return {p, v: p.map(() => 0)};
}

// Largest distance between ends of joints as drawn; 1 if there is none.
function sizeOf({model, joints}) {
  const points = joints.flatMap(({first, second}) => [first, second]).map((side) => drawnPlace(model, side));
  return Math.max(0, ...points.flatMap(([x, y]) => points.map((other) => Math.sqrt((other[0] - x) ** 2 + (other[1] - y) ** 2)))) || 1;
}

// The block, a Uint8Array, in absolute coordinates with steps of a fixed size; its measures are reactions, motors and springs.
export function blockOf(model, step = 1e-3, {p, v} = drawnStart(model)) {
  const tables = filledTables(model), texts = textTable(), {offset} = texts;
  const measures = tables.measures.map(([name, unit, kind, index, size, scale]) => [offset(name), offset(unit), MEASURE[kind], index, size, scale, 0]);
  const methods = METHODS.map(([table, name, values]) => [table, offset(name), ...Array.from({length: METHOD_VALUES}, (_, i) => values[i] ?? 0)]);
  const names = [...tables.links, ...tables.joints].map(({name}) => name).concat(tables.relationNames).map(offset);
  const joints = tables.joints.map((joint) => Object.values(jointEntry(tables, joint)).flat());
  const bodies = tables.links.map((link) => { const length = lengthOf(link); return [link.mass, link.mass * length ** 2 / 12, 0, -1]; });
  const entries = {gravity: [...model.gravity, sizeOf(tables)], bodies, joints, quantities: tables.quantities, terms: tables.terms, relations: tables.relations,
                   forces: tables.forces, ...swingSections(tables.swings), measures, start: [...p, ...v], outputs: measures.map((_, i) => i), settings: [[0, step, 0, 0, 0, 0, 0, 0, 0]],
                   methods, names};
  return packed(SECTIONS.map((section) => entries[section] ?? []), texts.bytes);
}

function packed(sections, bytes) {
  const numbers = sections.flat(2), padded = [...bytes, ...Array(-bytes.length & 7).fill(0)], counts = sections.map((entries) => entries.length);
  counts[SECTIONS.indexOf("texts")] = padded.length / 8;
  const head = 4 + SECTIONS.length, words = head + numbers.length + padded.length / 8;
  const block = new Uint8Array(8 * words), view = new DataView(block.buffer);
  block.set(new TextEncoder().encode("zdblock"));
  [VERSION, words, 2, ...counts, ...numbers].forEach((number, i) => view.setFloat64(8 * (i + 1), number, true));
  block.set(padded, 8 * (head + numbers.length));
  return block;
}

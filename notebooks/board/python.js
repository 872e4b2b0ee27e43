// The Python text of a mechanism of the drawing board, from a template for each kind of element.

import {angleOf, bodyOf, elementNamed, swingOf, turned} from "./model.js";

const text = (name) => JSON.stringify(name);
const number = (value) => String(value);
const pair = (values) => `(${values.map(number).join(", ")})`;
const side = (given) => (typeof given === "string" ? text(given) : `${given.body === "ground" ? "m.ground" : `m[${text(given.body)}]`}.point(${pair(given.local)})`);
const named = (values) => Object.entries(values).filter(([, value]) => value !== undefined).map(([name, value]) => `, ${name}=${value}`).join("");
const unlessZero = (value) => (value ? number(value) : undefined);

// Direction in the drawing of an axis in the frame of the joint's first body.
const drawnAxis = (model, {first, axis}) => {
  const body = elementNamed(model, bodyOf(first));
  return pair(body ? turned(angleOf(body), axis) : axis);
};

const LINES = {
  link: ({name, start, end, mass, length}) =>
    `m.link(${text(name)}, ${pair(start)}, ${pair(end)}${named({mass: number(mass), length: length === undefined ? undefined : number(length)})})`,
  revolute: ({name, first, second, damping}) => `m.revolute(${text(name)}, ${side(first)}, ${side(second)}${named({damping: unlessZero(damping)})})`,
  weld: ({name, first, second}) => `m.weld(${text(name)}, ${side(first)}, ${side(second)})`,
  prismatic: (joint, model) => `m.prismatic(${text(joint.name)}, ${side(joint.first)}, ${side(joint.second)}${
    named({axis: drawnAxis(model, joint), damping: unlessZero(joint.damping)})})`,
  slot: (joint, model) => `m.slot(${text(joint.name)}, ${text(bodyOf(joint.first))}, ${side(joint.second)}${named({axis: drawnAxis(model, joint)})})`,
  motor(motor) {
    const swing = swingOf(motor), law = swing ? `lambda t: ${swing.a} * math.cos(${swing.w} * t)` : number(motor.law);
    return `m.motor(${text(motor.name)}, ${text(motor.joint)}${named({[motor.drives]: law})})`;
  },
  point: ({name, body, local}) => `m.point(${text(name)}, ${text(body)}, ${pair(local)})`,
  force: ({name, point, along, value}) => `m.force(${text(name)}, ${side(point)}, ${pair(along)}, value=${number(value)})`,
  spring: ({name, first, second, ...values}) => `m.spring(${text(name)}, ${side(first)}, ${side(second)}${
    named(Object.fromEntries(["stiffness", "length", "damping"].map((key) => [key, number(values[key])])))})`,
};

const pathOf = (model) => {
  const points = model.elements.filter(({kind}) => kind === "point");
  return points.length ? `, path=[${points.map(({name}) => text(name)).join(", ")}]` : "";
};

export function pythonOf(model, span = 10, step = 1e-3) {
  return `${model.elements.some((element) => element.kind === "motor" && swingOf(element)) ? "import math\n\n" : ""}import zerodrift as zd

m = zd.Mechanism(${text(model.name)}, gravity=${pair(model.gravity)})
${model.elements.map((element) => LINES[element.kind](element, model)).join("\n")}

sol = zd.simulate(m, ${number(span)}, step=${number(step)})
zd.view(sol${pathOf(model)}).save(${text(`${model.name}.html`)})      # a film; in a notebook zd.view(sol) shows it
`;
}

// Numbers of a part that can be typed: label, value, and the change that a new value makes.

import {DRIVES_OF, UNITS_OF, angleOf, drawnPlace, elementNamed, lengthOf} from "./model.js";
import {moveTo, rename} from "./edit.js";

const needed = (value) => { if (!Number.isFinite(value)) throw new Error("a number is needed"); return value; };
const shown = (value) => +value.toPrecision(6);
const RAD = Math.PI / 180;

const field = (label, value, set, more = {}) => ({label, value, set, ...more});
const numberField = (label, name, key, more) => (model) => field(label, shown(elementNamed(model, name)[key]), (changed, value) => { elementNamed(changed, name)[key] = needed(value); }, more);

function linkFields(model, link) {
  return [
    field("length, m", shown(lengthOf(link)), (changed, value) => setLength(elementNamed(changed, link.name), needed(value)), {mustClose: true}),
    numberField("mass, kg", link.name, "mass")(model)];
}

// The end moves along the link; the core then closes the loops.
function setLength(link, value) {
  if (!(value > 0)) throw new Error("a length must be positive");
  const angle = angleOf(link);
  link.end = [link.start[0] + value * Math.cos(angle), link.start[1] + value * Math.sin(angle)];
  link.length = value;
}

const OTHERS = {revolute: ["revolute", "weld"], weld: ["revolute", "weld"], slot: ["slot", "prismatic"], prismatic: ["slot", "prismatic"]};
const OWN = {revolute: {damping: 0, cut: false}, weld: {cut: false}, slot: {}, prismatic: {damping: 0, cut: false}};

function setKind(model, name, kind) {
  const {first, second, axis} = elementNamed(model, name);
  model.elements = model.elements.map((element) => (element.name === name ? {kind, name, first, second, ...(axis ? {axis} : {}), ...OWN[kind]} : element));
  if (kind === "weld") model.elements = model.elements.filter((element) => element.joint !== name);
}

function jointFields(model, joint) {
  const {name} = joint, found = [field("kind", joint.kind, (changed, kind) => setKind(changed, name, kind), {choices: OTHERS[joint.kind]})];
  if (joint.axis) found.push(field("angle of the line, °", shown(Math.atan2(joint.axis[1], joint.axis[0]) / RAD), (changed, value) => {
    elementNamed(changed, name).axis = [Math.cos(needed(value) * RAD), Math.sin(value * RAD)];
  }));
  if (joint.first.body === "ground" && !joint.axis) found.push(...["x", "y"].map((axis, k) => field(`${axis}, m`, shown(drawnPlace(model, joint.first)[k]),
    (changed, value) => moveTo(changed, joint.first, drawnPlace(changed, joint.first).map((each, i) => (i === k ? needed(value) : each))), {mustClose: true})));
  for (const key of ["first", "second"]) {
    const side = joint[key];
    if (side.body && side.body !== "ground" && !side.local[1]) found.push(field(`along ${side.body}, m`, shown(side.local[0]),
      (changed, value) => { elementNamed(changed, name)[key].local[0] = needed(value); }, {mustClose: true}));
  }
  if (joint.damping !== undefined) found.push(numberField(joint.kind === "revolute" ? "damping, N m s/rad" : "damping, N s/m", name, "damping")(model));
  return found;
}

function motorFields(model, motor) {
  const {kind} = elementNamed(model, motor.joint);
  return [field("sets", motor.drives, (changed, drives) => { elementNamed(changed, motor.name).drives = drives; }, {choices: DRIVES_OF[kind]}),
          numberField(`${motor.drives}, ${UNITS_OF[motor.drives][kind]}`, motor.name, "law")(model)];
}

const springFields = (model, {name}) => [numberField("stiffness, N/m", name, "stiffness")(model), numberField("free length, m", name, "length")(model),
                                         numberField("damping, N s/m", name, "damping")(model)];
const pointFields = (model, {name}) => ["along the link, m", "beside it, m"].map((label, k) => field(label, shown(elementNamed(model, name).local[k]),
  (changed, value) => { elementNamed(changed, name).local[k] = needed(value); }));
// Components of a load; its direction stays where it vanishes.
const loadFields = (model, {name, along, value}) => ["x", "y"].map((axis, k) => field(`force ${axis}, N`, shown(along[k] * value), (changed, given) => {
  const load = elementNamed(changed, name), force = load.along.map((x, i) => (i === k ? needed(given) : x * load.value)), size = Math.hypot(...force);
  Object.assign(load, {value: size, along: size ? force.map((x) => x / size) : load.along});
}));
const FIELDS = {point: pointFields, force: loadFields, link: linkFields, revolute: jointFields, weld: jointFields, slot: jointFields, prismatic: jointFields, motor: motorFields, spring: springFields};

// Fields of the named part; without a name those of the whole mechanism.
export function fieldsOf(model, name) {
  if (!name) return [field("name", model.name, (changed, value) => { changed.name = value; }),
                     ...["x", "y"].map((axis, k) => field(`gravity ${axis}, m/s²`, model.gravity[k], (changed, value) => { changed.gravity[k] = needed(value); }))];
  const part = elementNamed(model, name);
  return [field("name", name, (changed, value) => rename(changed, name, value)), ...FIELDS[part.kind](model, part)];
}

// Numbers of a part that can be typed: label, value, and the change that a new value makes.

import {DRIVES_OF, UNITS_OF, angleOf, drawnPlace, elementNamed, lengthOf, swingLaw, swingOf} from "./model.js";
import {moveTo, rename} from "./edit.js";

const needed = (value) => { if (!Number.isFinite(value)) throw new Error("a number is needed"); return value; };
const shown = (value) => +value.toPrecision(6);
const RAD = Math.PI / 180;

const field = (label, value, set, more = {}) => ({label, value, set, ...more});
const numberField = (label, name, key, more) => (model) => field(label, shown(elementNamed(model, name)[key]), (changed, value) => { elementNamed(changed, name)[key] = needed(value); }, more);

function linkFields(model, link) {
  return [
    field("length, m", shown(lengthOf(link)), (changed, value) => setLength(elementNamed(changed, link.name), needed(value)), {mustClose: true}),
    numberField("mass, kg", link.name, "mass")(model),
    field("angle, °", shown(angleOf(link) / RAD), (changed, value) => {
      const {start} = elementNamed(changed, link.name), length = lengthOf(elementNamed(changed, link.name)), angle = needed(value) * RAD;
      moveTo(changed, `${link.name}.end`, [start[0] + length * Math.cos(angle), start[1] + length * Math.sin(angle)]);
    }),
    ...["start", "end"].flatMap((end) => ["x", "y"].map((axis, k) => field(`${end} ${axis}, m`, shown(link[end][k]), (changed, value) =>
      moveTo(changed, `${link.name}.${end}`, elementNamed(changed, link.name)[end].map((each, i) => (i === k ? needed(value) : each))))))];
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
  const {kind} = elementNamed(model, motor.joint), swing = swingOf(motor), [unit, label] = kind === "revolute" ? [RAD, "°"] : [1, "m"];
  const set = (changes) => (changed, value) => Object.assign(elementNamed(changed, motor.name), changes(value));
  const sets = field("sets", swing ? "swing" : motor.drives, set((drives) => (drives === "swing" ? {drives: "speed", law: swingLaw(0.5 * Math.PI, Math.PI)} :
    {drives, law: swing ? 2 : motor.law})), {choices: [...DRIVES_OF[kind], "swing"]});
  if (!swing) return [sets, numberField(`${motor.drives}, ${UNITS_OF[motor.drives][kind]}`, motor.name, "law")(model)];
  const {a, w} = swing, turn = 2 * Math.PI;
  return [sets, field(`amplitude, ${label}`, shown(a / w / unit), set((value) => ({law: swingLaw(needed(value) * unit * w, w)}))),
          field("frequency, Hz", shown(w / turn), set((value) => ({law: swingLaw(a / w * needed(value) * turn, value * turn)})))];
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

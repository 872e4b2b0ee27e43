// Shapes of a drawing for the player's picture.js, as it is drawn or in motion, and what is said of its mechanism.

import {angleOf, bodyOf, drawnPlace, elementNamed, isJoint, lengthOf, localOf, ofKind, swingOf, turned} from "./model.js";

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

// Sides of elements, with the points that are named.
export const sidesOf = (element) => [element.first, element.second, element.point, element.kind === "point" ? element : null].filter(Boolean);

// Shapes [kind, name, numbers of points, number] and their points; size is the radius of a pin in m.
export function shapesOf(model, p, size) {
  const placed = placesOf(model, p), at = [], shapes = [], minus = (a, b) => [a[0] - b[0], a[1] - b[1]];
  const put = (kind, name, points, number = 0) => shapes.push([kind, name, points.map((point) => at.push(point) - 1), number]);
  const angle = (name) => { const [a, b] = ["start", "end"].map((end) => placed(`${name}.${end}`)); return Math.atan2(b[1] - a[1], b[0] - a[0]); };
  const way = ({first, axis}) => (bodyOf(first) === "ground" ? axis : turned(angle(bodyOf(first)), axis));
  const sides = model.elements.flatMap(sidesOf);
  for (const {name} of ofKind(model, "link")) {
    const corners = sides.filter((side) => side.body === name && side.local[1]);
    put("link", name, [`${name}.start`, `${name}.end`, ...corners].map(placed));
  }
  for (const spring of ofKind(model, "spring")) {
    put("spring", spring.name, [placed(spring.first), placed(spring.second)]);
    for (const side of [spring.first, spring.second]) if (side.body === "ground") put("ground", "", [side.local]);
  }
  for (const joint of model.elements.filter(isJoint)) {
    const [a, b] = [placed(joint.first), placed(joint.second)], isOnGround = bodyOf(joint.first) === "ground";
    if (joint.axis) {
      const axis = way(joint), s = (b[0] - a[0]) * axis[0] + (b[1] - a[1]) * axis[1], ends = [Math.min(0, s) - 9 * size, Math.max(0, s) + 9 * size];
      put(isOnGround ? "rail" : "guide", joint.name, [...ends.map((each) => [a[0] + each * axis[0], a[1] + each * axis[1]]), [-axis[1], axis[0]]]);
      if (joint.kind === "prismatic") put("slider", joint.name, [b, axis]);
      else put("pin", joint.name, [b]);
      continue;
    }
    if (isOnGround) put("ground", joint.name, [b]);
    put(joint.kind === "weld" ? "weld" : "pin", joint.name, joint.kind === "weld" ? [b, [1, 0]] : [b]);
  }
  for (const motor of ofKind(model, "motor")) {
    const {name, joint} = motor, law = swingOf(motor)?.a ?? motor.law, on = elementNamed(model, joint), b = placed(on.second);
    if (on.axis) put("drive", name, [b, way(on), turned(Math.PI / 2, way(on))], law);
    else put("motor", name, [b], law);
  }
  for (const point of ofKind(model, "point")) put("mark", point.name, [placed(point)]);
  for (const {name, point, along, value} of ofKind(model, "force")) {
    const sign = value < 0 ? -1 : 1, tip = placed(point);
    put("load", name, [minus(tip, along.map((x) => 8 * size * sign * x)), along.map((x) => sign * x)]);
  }
  return {shapes, at};
}

// Bodies that no joints lead to from the ground.
export function looseOf(model) {
  const held = new Set(["ground"]), joints = model.elements.filter(isJoint).map(({first, second}) => [bodyOf(first), bodyOf(second)]);
  for (let grown = true; grown;) {
    grown = false;
    for (const pair of joints) if (pair.some((each) => held.has(each)) && !pair.every((each) => held.has(each))) { pair.forEach((each) => held.add(each)); grown = true; }
  }
  return ofKind(model, "link").map(({name}) => name).filter((name) => !held.has(name));
}

// "moves: yes, driven by motor1; freedom 0 (1 without it)": drives are constraints, as in Python.
export function movesOf(model, free) {
  const motors = ofKind(model, "motor"), speeds = motors.filter((motor) => motor.drives === "speed").map(({name}) => name);
  const pushing = motors.filter((motor) => motor.drives !== "speed").map(({name}) => name), count = free + speeds.length, given = speeds.length > 1 ? "them" : "it";
  if (!count) return "moves: no, its links hold each other";
  const by = [...(speeds.length ? [`driven by ${speeds.join(", ")}`] : []), ...(pushing.length ? [`pushed by ${pushing.join(", ")}`] : [])];
  return `${["moves: yes", ...by].join(", ")}; freedom ${free}${speeds.length ? ` (${count} without ${given})` : ""}`;
}

// Links that lie in one line at a pin, in which a crank can be locked, for poses p of mass centres.
export function stretchedOf(model, p) {
  const links = ofKind(model, "link"), turn = (name) => p[3 * links.findIndex((link) => link.name === name) + 2];
  return ofKind(model, "revolute").map(({first, second}) => [bodyOf(first), bodyOf(second)])
    .filter(([a, b]) => a !== "ground" && b !== "ground" && Math.abs(Math.sin(turn(a) - turn(b))) < 0.12);
}

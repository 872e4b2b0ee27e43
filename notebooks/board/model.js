// Mechanisms of the drawing board: the file format of `Mechanism.save`, for links, joints, motors, springs, points and loads in the plane.
// What comes from an address or a file is checked here before anything else sees it.

const MAX_ELEMENTS = 200, LARGEST_TEXT = 100000, LARGEST_NUMBER = 1e6;
const NAME = /^[A-Za-z0-9_-]([A-Za-z0-9_ -]{0,38}[A-Za-z0-9_-])?$/;
export const DRIVES_OF = {revolute: ["speed", "torque"], slot: ["speed", "force"], prismatic: ["speed", "force"]};
export const UNITS_OF = {speed: {revolute: "rad/s", slot: "m/s", prismatic: "m/s"}, torque: {revolute: "N m"}, force: {slot: "N", prismatic: "N"}};

export function emptyModel(name = "board") {
  return {zerodrift: "mechanism", version: 1, name, dimension: 2, gravity: [0, -9.81], parameters: {}, elements: [], start: {}, wish: {}};
}

// ---- checks: each throws an Error whose sentence states the rule ----

function refuse(rule) {
  throw new Error(rule);
}

function checkedKeys(what, given, needed, optional = []) {
  if (given === null || typeof given !== "object" || Array.isArray(given)) refuse(`${what} must be an object`);
  for (const key of needed) if (!Object.hasOwn(given, key)) refuse(`${what} must have ${key}`);
  for (const key of Object.keys(given)) if (![...needed, ...optional].includes(key)) refuse(`${what} must not have ${key.slice(0, 40)}`);
}

function checkedNumber(what, value, least = -LARGEST_NUMBER) {
  if (typeof value !== "number" || !Number.isFinite(value) || value < least || Math.abs(value) > LARGEST_NUMBER)
    refuse(`${what} must be a number from ${least} to ${LARGEST_NUMBER}`);
  return value;
}

function checkedPair(what, value) {
  if (!Array.isArray(value) || value.length !== 2) refuse(`${what} must have two numbers`);
  return value.map((each) => checkedNumber(what, each));
}

function checkedName(what, value, taken) {
  if (typeof value !== "string" || !NAME.test(value)) refuse(`${what} must have a name of at most 40 letters, digits, blanks inside, '_' and '-'`);
  if (value === "ground" || taken.has(value)) refuse(`${what} must have a name of its own, and ${value} is taken`);
  return value;
}

const nameOf = (element) => `${element.kind} ${element.name}`;

// Point of a body: "crank.end", or a body and its coordinates in the body's frame, which begins at a link's start.
function checkedSide(what, side, known) {
  if (typeof side === "string") {
    const [name, end, more] = side.split(".");
    if (known.get(name)?.kind !== "link" || !["start", "end"].includes(end) || more !== undefined)
      refuse(`${what} must be the start or the end of a link that stands before it`);
    return side;
  }
  checkedKeys(what, side, ["body", "local"]);
  if (side.body !== "ground" && known.get(side.body)?.kind !== "link") refuse(`${what} must be of the ground or of a link that stands before it`);
  return {body: side.body, local: checkedPair(what, side.local)};
}

function checkedSides(element, known) {
  const first = checkedSide(`first of ${nameOf(element)}`, element.first, known), second = checkedSide(`second of ${nameOf(element)}`, element.second, known);
  if (bodyOf(first) === bodyOf(second)) refuse(`${nameOf(element)} must join two bodies`);
  return {first, second};
}

function checkedAxis(element) {
  const axis = checkedPair(`axis of ${nameOf(element)}`, element.axis);
  if (Math.abs(Math.hypot(...axis) - 1) > 1e-9) refuse(`axis of ${nameOf(element)} must have length 1`);
  return axis;
}

// Speed a cos(w t) of a motor that swings by a / w about the drawing, and the numbers a and w of such a law.
export const swingLaw = (a, w) => ({expression: ["*", a, ["cos", ["*", w, "t"]]], of: {}});
export const swingOf = ({law}) => (typeof law === "number" ? null : {a: law.expression[1], w: law.expression[2][1][1]});

function checkedLaw(what, {law, drives}) {
  if (drives !== "speed" || law === null || typeof law !== "object") return checkedNumber(`law of ${what}`, law);
  const a = law.expression?.[1], w = law.expression?.[2]?.[1]?.[1];
  if (JSON.stringify(law) !== JSON.stringify(swingLaw(a, w))) refuse(`law of ${what} must be a number or a cos(w t)`);
  if (!checkedNumber(`amplitude of ${what}`, a) || !(checkedNumber(`frequency of ${what}`, w) > 0)) refuse(`${what} must swing: its amplitude and frequency must not be 0`);
  return swingLaw(a, w);
}

const jointOf = (keys, more) => (element, known) => {
  checkedKeys(nameOf(element), element, ["kind", "name", "first", "second", ...keys]);
  if (keys.includes("cut") && element.cut !== false) refuse(`cut of ${nameOf(element)} must be false`);
  return {...checkedSides(element, known), ...more(element)};
};
const damped = (element) => checkedNumber(`damping of ${nameOf(element)}`, element.damping, 0);

const CHECKS = {
  link(element) {
    const what = nameOf(element);
    checkedKeys(what, element, ["kind", "name", "start", "end", "mass"], ["length"]);
    const start = checkedPair(`start of ${what}`, element.start), end = checkedPair(`end of ${what}`, element.end);
    const found = {start, end, mass: checkedNumber(`mass of ${what}`, element.mass, 0)};
    if (!(Math.hypot(end[0] - start[0], end[1] - start[1]) > 0)) refuse(`${what} must have two ends in different places`);
    if (element.length === undefined) return found;
    if (!(checkedNumber(`length of ${what}`, element.length) > 0)) refuse(`length of ${what} must be positive`);
    return {...found, length: element.length};
  },
  revolute: jointOf(["damping", "cut"], (element) => ({damping: damped(element), cut: false})),
  weld: jointOf(["cut"], () => ({cut: false})),
  slot: jointOf(["axis"], (element) => ({axis: checkedAxis(element)})),
  prismatic: jointOf(["axis", "damping", "cut"], (element) => ({axis: checkedAxis(element), damping: damped(element), cut: false})),
  motor(element, known) {
    const what = nameOf(element), joint = known.get(element.joint);
    checkedKeys(what, element, ["kind", "name", "joint", "drives", "law"]);
    if (!DRIVES_OF[joint?.kind]) refuse(`${what} must have a joint that stands before it, with an angle or a displacement`);
    if (!DRIVES_OF[joint.kind].includes(element.drives)) refuse(`${what} must drive ${DRIVES_OF[joint.kind].join(" or ")}`);
    if ([...known.values()].some((each) => each.kind === "motor" && each.joint === element.joint && each.drives === "speed" && element.drives === "speed"))
      refuse(`${what} must be the only motor that sets the speed of ${element.joint}`);
    return {joint: element.joint, drives: element.drives, law: checkedLaw(what, element)};
  },
  point(element, known) {
    checkedKeys(nameOf(element), element, ["kind", "name", "body", "local"]);
    return checkedSide(nameOf(element), {body: element.body, local: element.local}, known);
  },
  force(element, known) {
    const what = nameOf(element);
    checkedKeys(what, element, ["kind", "name", "point", "along", "frame", "value"]);
    if (element.frame !== "ground") refuse(`frame of ${what} must be ground`);
    const along = checkedPair(`along of ${what}`, element.along);
    if (Math.abs(Math.hypot(...along) - 1) > 1e-9) refuse(`along of ${what} must have length 1`);
    return {point: checkedSide(`point of ${what}`, element.point, known), along, frame: "ground", value: checkedNumber(`value of ${what}`, element.value)};
  },
  spring(element, known) {
    const what = nameOf(element);
    checkedKeys(what, element, ["kind", "name", "first", "second", "stiffness", "length", "damping"]);
    return {...checkedSides(element, known), stiffness: checkedNumber(`stiffness of ${what}`, element.stiffness, 0),
            length: checkedNumber(`length of ${what}`, element.length, 0), damping: checkedNumber(`damping of ${what}`, element.damping, 0)};
  },
};

// A copy with known keys alone.
export function checkedModel(given) {
  const keys = Object.keys(emptyModel());
  checkedKeys("a mechanism", given, keys);
  if (given.zerodrift !== "mechanism" || given.version !== 1) refuse("a mechanism must begin with \"zerodrift\": \"mechanism\" and version 1");
  if (given.dimension !== 2) refuse("the drawing board must have a mechanism in the plane");
  for (const key of ["parameters", "start", "wish"]) checkedKeys(`${key} of a mechanism of the drawing board`, given[key], []);
  if (!Array.isArray(given.elements) || given.elements.length > MAX_ELEMENTS) refuse(`a mechanism must have a list of at most ${MAX_ELEMENTS} elements`);
  const known = new Map(), model = emptyModel(checkedName("the mechanism", given.name, known));
  model.gravity = checkedPair("gravity", given.gravity);
  for (const element of given.elements) {
    if (element === null || typeof element !== "object" || !Object.hasOwn(CHECKS, element.kind))
      refuse(`an element of the drawing board must be one of ${Object.keys(CHECKS).join(", ")}`);
    const name = checkedName(`a ${element.kind}`, element.name, known);
    known.set(name, {kind: element.kind, name, ...CHECKS[element.kind](element, known)});
  }
  model.elements = [...known.values()];
  return model;
}

export function parsedModel(text) {
  if (text.length > LARGEST_TEXT) refuse(`a mechanism must have at most ${LARGEST_TEXT} letters, not ${text.length}`);
  let given;
  try {
    given = JSON.parse(text);
  } catch {
    refuse("a mechanism must be JSON, as the drawing board and Mechanism.save write it");
  }
  return checkedModel(given);
}

// ---- addresses: JSON in base 64 whose letters need no escape ----

export function addressOf(model) {
  const bytes = new TextEncoder().encode(JSON.stringify(model));
  return "#m=" + btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

export function modelOfAddress(hash) {
  const text = hash.replace(/^#m=/, "");
  if (text.length > 2 * LARGEST_TEXT) refuse(`an address must have at most ${2 * LARGEST_TEXT} letters, not ${text.length}`);
  if (!/^[A-Za-z0-9_-]*$/.test(text)) refuse("an address must have letters of base 64 after #m=");
  let letters;
  try {
    letters = new TextDecoder("utf-8", {fatal: true}).decode(Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0)));
  } catch {
    refuse("an address must be whole: some of its letters are missing or changed");
  }
  return parsedModel(letters);
}

// ---- geometry of the drawing ----

// A square and its rounding error, by Dekker's product.
function square(x) {
  const big = 134217729 * x, high = big - (big - x), low = x - high, product = x * x;
  return [product, low * low - (product - high * high - 2 * high * low)];
}

// Root of x^2 + y^2 with one step of Newton's method on its exact residual: rounded as the C library's, which Math.hypot is not.
export function hypot(x, y) {
  const root = Math.sqrt(x * x + y * y);
  if (!root) return 0;
  const [a, da] = square(Math.max(Math.abs(x), Math.abs(y))), [b, db] = square(Math.min(Math.abs(x), Math.abs(y))), [c, dc] = square(root);
  return root - ((c - a) - b + (dc - da - db)) / (2 * root);
}

export const ofKind = (model, ...kinds) => model.elements.filter((element) => kinds.includes(element.kind));
export const bodyOf = (side) => (typeof side === "string" ? side.split(".")[0] : side.body);
export const elementNamed = (model, name) => model.elements.find((element) => element.name === name);
export const isJoint = (element) => ["revolute", "weld", "slot", "prismatic"].includes(element.kind);
export const angleOf = (link) => Math.atan2(link.end[1] - link.start[1], link.end[0] - link.start[0]);
export const lengthOf = (link) => link.length ?? hypot(link.end[0] - link.start[0], link.end[1] - link.start[1]);
export const turned = (angle, [x, y]) => [Math.cos(angle) * x - Math.sin(angle) * y, Math.sin(angle) * x + Math.cos(angle) * y];

// Coordinates of a point in the frame of its body.
export function localOf(model, side) {
  if (typeof side !== "string") return side.local;
  return side.endsWith(".start") ? [0, 0] : [lengthOf(elementNamed(model, bodyOf(side))), 0];
}

// Place of a point in the drawing.
export function drawnPlace(model, side) {
  const body = elementNamed(model, bodyOf(side));
  if (typeof side === "string") return side.endsWith(".start") ? body.start : body.end;
  if (!body) return side.local;
  const [x, y] = turned(angleOf(body), side.local);
  return [body.start[0] + x, body.start[1] + y];
}

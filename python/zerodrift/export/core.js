// Mechanisms in the browser and in node: plain functions over the core in WebAssembly and a block of data (csrc/block/block.h).
//
//     const core = await load(bytes);                    // the core, an ArrayBuffer or Uint8Array
//     const crank = create(core, block);                 // the block, a Uint8Array as zd.block() writes it
//     setInput(crank, "motor.torque", 3);
//     step(crank, 10);
//     read(crank, "crank.angle");                        // Float64Array
//
// What fails throws an Error with the core's sentence; the mechanism stays at its last good state.

// Functions of the operating system that the core's C library imports. None is needed: a clock that stands gives steps all their time.
function noSystem(module) {
  const imports = {};
  for (const {module: from, name} of WebAssembly.Module.imports(module)) (imports[from] ??= {})[name] = () => 52;
  return imports;
}

// Compiles the core; many mechanisms may share it.
export async function load(bytes) {
  return WebAssembly.compile(bytes);
}

function textAt(m, address) {
  const bytes = new Uint8Array(m.core.memory.buffer);
  let end = address;
  while (bytes[end]) end++;
  return new TextDecoder().decode(bytes.slice(address, end));
}

// Doubles in the core's memory: a view that is valid until memory grows.
const doublesAt = (m, address, count) => new Float64Array(m.core.memory.buffer, address, count);

// Copies doubles into the core's memory while a function uses them.
function withDoubles(m, arrays, use) {
  const addresses = arrays.map((array) => m.core.page_take(8 * Math.max(array.length, 1)));
  arrays.forEach((array, i) => doublesAt(m, addresses[i], array.length).set(array));
  try {
    return use(...addresses);
  } finally {
    addresses.forEach((address) => m.core.page_give(address));
  }
}

function check(m, status) {
  if (status < 0) throw new Error(textAt(m, m.core.page_message(m.run)) || "the core refused this");
}

function listed(m, count, name) {
  return Array.from({length: count}, (_, i) => textAt(m, name(i)));
}

function indexOf(names, name, what) {
  const index = names.indexOf(name);
  if (index < 0) throw new Error(`there is no ${what} ${name}; there are ${names.join(", ")}`);
  return index;
}

// Makes a mechanism from a block, with its run at time t; with `assembled`, from its start projected onto the constraints.
export function create(core, block, t = 0, assembled = false) {
  const instance = new WebAssembly.Instance(core, noSystem(core));
  const m = {core: instance.exports};
  m.core._initialize?.();
  const bytes = block instanceof Uint8Array ? block : new Uint8Array(block);
  m.build = digest(new Uint8Array(m.core.memory.buffer));      // tables and texts of a core that has not run
  m.block = digest(bytes);
  const address = m.core.page_take(bytes.length || 1);
  new Uint8Array(m.core.memory.buffer).set(bytes, address);
  m.run = (assembled ? m.core.page_open_assembled : m.core.page_open)(address, bytes.length, t);
  m.core.page_give(address);
  if (!m.run) throw new Error(textAt(m, m.core.page_error()));
  const {core: c, run} = m;
  m.measures = listed(m, c.page_measures(run), (i) => c.page_measure_name(run, i));
  m.inputs = listed(m, c.page_inputs(run), (i) => c.page_input_name(run, i));
  m.parameters = listed(m, c.page_parameters(run), (i) => c.page_parameter_name(run, i));
  m.constraints = listed(m, c.page_m(run), (i) => c.page_constraint(run, i));
  return m;
}

// Gives the memory of a mechanism back.
export function close(m) {
  if (m.run) m.core.page_close(m.run);
  m.run = 0;
}

export function setInput(m, name, value) {
  if (m.core.page_set_input(m.run, indexOf(m.inputs, name, "input"), value) < 0) throw new Error(`input ${name} must be finite, not ${value}`);
}

export function input(m, name) {
  return m.core.page_input(m.run, indexOf(m.inputs, name, "input"));
}

// Changes a parameter; the mechanism is assembled anew, as near to where it is as its constraints allow.
export function setParameter(m, name, value) {
  check(m, m.core.page_set_parameter(m.run, indexOf(m.parameters, name, "parameter"), value));
}

export function parameter(m, name) {
  return m.core.page_parameter(m.run, indexOf(m.parameters, name, "parameter"));
}

// Makes steps of the block's size.
export function step(m, steps = 1) {
  check(m, m.core.page_step(m.run, steps));
}

// Steps to a time, the last one being shorter if it must.
export function advance(m, t) {
  check(m, m.core.page_advance(m.run, t));
}

export function time(m) {
  return m.core.page_time(m.run);
}

export function positions(m) {
  return doublesAt(m, m.core.page_p(m.run), m.core.page_nq(m.run)).slice();
}

export function velocities(m) {
  return doublesAt(m, m.core.page_v(m.run), m.core.page_nv(m.run)).slice();
}

// Poses of the bodies at the present state, one after another: x, y, angle in the plane; in space the mass centre and the three principal axes.
export function poses(m) {
  const size = m.core.page_bodies(m.run) * m.core.page_pose(m.run);
  return withDoubles(m, [new Float64Array(size)], (address) => {
    m.core.page_poses(m.run, address);
    return doublesAt(m, address, size).slice();
  });
}

// Components of a measure at the present state.
export function read(m, name) {
  const index = indexOf(m.measures, name, "measure"), size = m.core.page_measure_size(m.run, index);
  return withDoubles(m, [new Float64Array(size)], (address) => {
    if (m.core.page_measure(m.run, index, address) < 0) throw new Error(`measure ${name} is not defined here`);
    return doublesAt(m, address, size).slice();
  });
}

export function unit(m, name) {
  return textAt(m, m.core.page_measure_unit(m.run, indexOf(m.measures, name, "measure")));
}

// Degrees of freedom, rank, and redundant constraints by name.
export function freedoms(m) {
  const count = m.constraints.length, rank = count ? m.core.page_rank(m.run) : 0, rows = m.core.page_take(4 * Math.max(count, 1));
  const redundant = count > rank ? m.core.page_redundant(m.run, rows) : 0;
  const names = Array.from(new Int32Array(m.core.memory.buffer, rows, redundant), (row) => m.constraints[row]);
  m.core.page_give(rows);
  return {freedoms: m.core.page_nv(m.run) - rank, rank, redundant: names};
}

// Largest residual of the position constraints.
export function violation(m) {
  return m.core.page_violation(m.run);
}

// Error of the energy in J since the run began, or NaN for a mechanism without potential energy.
export function energyViolation(m) {
  return m.core.page_energy_violation(m.run);
}

// Moves the mechanism so that a point, a measure's name or a function that returns its place, comes nearer to a target, and at rest: one
// step of least squares by differences along the coordinates, each of which the constraints follow. Returns the distance that is left.
export function pull(m, point, target) {
  const here = () => (typeof point === "function" ? point() : read(m, point));
  const state = save(m), still = state.v.map(() => 0), at = Array.from(here());
  const begin = (p) => restore(m, {...state, p, v: still}, true);
  const columns = state.p.map((x, i) => {
    const p = state.p.slice(), change = 1e-6 * Math.max(1, Math.abs(x));
    p[i] += change;
    begin(p);
    return Array.from(here(), (value, k) => (value - at[k]) / change);
  });
  const size = at.length, A = Array.from({length: size}, (_, i) => Array.from({length: size + 1}, (_, j) =>
    j === size ? target[i] - at[i] : columns.reduce((sum, column) => sum + column[i] * column[j], 0)));
  const damping = 1e-4 * A.reduce((sum, row, i) => sum + row[i], 1e-12);
  A.forEach((row, i) => { row[i] += damping; });
  for (let i = 0; i < size; i++)
    for (let k = 0; k < size; k++)
      if (k !== i) for (let j = size, factor = A[k][i] / A[i][i]; j >= i; j--) A[k][j] -= factor * A[i][j];
  const change = columns.map((column) => A.reduce((sum, row, i) => sum + column[i] * row[size] / row[i], 0));
  const most = 0.3 / Math.max(0.3, ...change.map(Math.abs));
  begin(state.p.map((x, i) => x + most * change[i]));
  return Math.hypot(...Array.from(here(), (value, k) => value - target[k]));
}

// FNV-1a over the words of whole ones of these bytes.
function digest(bytes) {
  let sum = 0x811c9dc5;
  for (const word of new Uint32Array(bytes.slice(0, bytes.length & ~3).buffer)) sum = Math.imul(sum ^ word, 0x01000193) >>> 0;
  return sum;
}

const STATE = [0x6d77647a, 1], HEADER = 28;        // "zdwm" and the version of saved runs; bytes before the memory
const PAGE = 65536, LARGEST = 4096;                // bytes of a page of memory, and its pages

// The whole run: a mechanism has the core's memory for itself, so a copy of it is the run's state, with factors, pivots and step control.
// It goes on with the same bits in any mechanism of the same build of the core and the same block.
export function saveRun(m) {
  const memory = new Uint8Array(m.core.memory.buffer);
  let end = memory.length;
  while (end && !memory[end - 1]) end--;
  const used = memory.slice(0, end + (-end & 3)), saved = new Uint8Array(HEADER + used.length);
  new Uint32Array(saved.buffer, 0, HEADER / 4).set([...STATE, m.build, m.block, m.run, memory.length / PAGE, digest(used)]);
  saved.set(used, HEADER);
  return saved;
}

// Continues a saved run; a state that is not whole, or of another build or block, is refused, and the mechanism stays.
export function restoreRun(m, saved) {
  const used = saved.slice(HEADER), words = new Uint32Array(saved.length < HEADER ? 7 : saved.slice(0, HEADER).buffer);
  const [name, version, build, block, run, pages, sum] = words;
  if (name !== STATE[0] || version !== STATE[1]) throw new Error("a saved run must begin with zdwm and its version");
  if (build !== m.build) throw new Error("a saved run must be of the same build of the core");
  if (block !== m.block) throw new Error("a saved run must be of the same block");
  if (pages > LARGEST || used.length > pages * PAGE || used.length % 4 || sum !== digest(used))
    throw new Error("a saved run must be whole: some of its bytes are missing or changed");
  const missing = pages - m.core.memory.buffer.byteLength / PAGE;
  if (missing > 0) m.core.memory.grow(missing);
  const memory = new Uint8Array(m.core.memory.buffer);
  memory.fill(0, used.length);
  memory.set(used);
  m.run = run;
}

// The state: time, coordinates, velocities and inputs, as JSON can keep them.
export function save(m) {
  return {t: time(m), p: [...positions(m)], v: [...velocities(m)], inputs: Object.fromEntries(m.inputs.map((name) => [name, input(m, name)]))};
}

// Begins a new run at a saved state, which must satisfy the constraints; with `assembled`, at the nearest state that does.
export function restore(m, state, assembled = false) {
  if (state.p.length !== m.core.page_nq(m.run) || state.v.length !== m.core.page_nv(m.run))
    throw new Error("the state must have as many coordinates and velocities as the mechanism");
  for (const [name, value] of Object.entries(state.inputs ?? {})) setInput(m, name, value);
  const begin = assembled ? m.core.page_assemble : m.core.page_restart;
  withDoubles(m, [state.p, state.v], (p, v) => check(m, begin(m.run, state.t, p, v)));
}

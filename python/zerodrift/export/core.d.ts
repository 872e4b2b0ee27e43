/** A mechanism with its run. */
export interface Mechanism {
  readonly measures: string[];
  readonly inputs: string[];
  readonly parameters: string[];
  readonly constraints: string[];
}

/** State of a mechanism, as JSON can keep it. */
export interface State {
  t: number;
  p: number[];
  v: number[];
  inputs?: Record<string, number>;
}

/** Compiles the core; many mechanisms may share it. */
export function load(bytes: BufferSource): Promise<WebAssembly.Module>;
/** Makes a mechanism from a block of `zd.block()`, with its run at time t in s; with `assembled`, from its start projected onto the
 * constraints. */
export function create(core: WebAssembly.Module, block: Uint8Array | ArrayBuffer, t?: number, assembled?: boolean): Mechanism;
export function close(m: Mechanism): void;
export function setInput(m: Mechanism, name: string, value: number): void;
export function input(m: Mechanism, name: string): number;
/** Changes a parameter and assembles the mechanism anew; if it cannot close, an Error, and everything stays. */
export function setParameter(m: Mechanism, name: string, value: number): void;
export function parameter(m: Mechanism, name: string): number;
/** Makes steps of the block's size. */
export function step(m: Mechanism, steps?: number): void;
/** Steps to time t in s. */
export function advance(m: Mechanism, t: number): void;
export function time(m: Mechanism): number;
export function positions(m: Mechanism): Float64Array;
export function velocities(m: Mechanism): Float64Array;
/** Poses of the bodies, one after another: x, y, angle in the plane; in space the mass centre and the three principal axes. */
export function poses(m: Mechanism): Float64Array;
/** Components of a measure at the present state. */
export function read(m: Mechanism, name: string): Float64Array;
export function unit(m: Mechanism, name: string): string;
export function freedoms(m: Mechanism): {freedoms: number; rank: number; redundant: string[]};
/** Largest residual of the position constraints. */
export function violation(m: Mechanism): number;
/** Error of the energy in J since the run began: it begins anew after a parameter has changed or a point was pulled. */
export function energyViolation(m: Mechanism): number;
/** Moves a point, a measure or a function that returns its place, nearer to a target and returns the distance that is left. */
export function pull(m: Mechanism, point: string | (() => ArrayLike<number>), target: ArrayLike<number>): number;
/** The whole run, from which `restoreRun` continues with the same bits. */
export function saveRun(m: Mechanism): Uint8Array;
/** Continues a saved run of the same build of the core and the same block; another one is refused with an Error. */
export function restoreRun(m: Mechanism, saved: Uint8Array): void;
export function save(m: Mechanism): State;
/** Begins a new run at a saved state; with `assembled`, at the nearest one that satisfies the constraints. */
export function restore(m: Mechanism, state: State, assembled?: boolean): void;

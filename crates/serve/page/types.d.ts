// The documents that the page gets, as docs/interface.md has them. For the type checker alone: nothing of this is served.

export interface Stations {
  s: number[]; x: number[]; y: number[]; nu: number[]; eta: number[]; mu: number[]; beta: number[];
  alpha: number[]; n_a: number[]; n_b: number[];
  /** Of an arm in the plane. */
  theta?: number[]; m?: number[];
  /** Of an arm in space. */
  z?: number[]; a?: Place[]; b?: Place[]; c?: Place[]; zeta?: number[]; tau?: number[]; kappa?: number[];
  n_c?: number[]; m_a?: number[]; m_b?: number[]; m_c?: number[];
}

export interface Note { kind: string; message: string }
/** With theta in the plane, with z and directors in space. */
export interface Tip { x: number; y: number; alpha: number; theta?: number; z?: number; a?: Place; b?: Place; c?: Place }
/** Two forces and a moment in the plane, three each in space. */
export interface Wrench { force: number[]; moment: number | number[] }
/** An angle (deg) in the plane of e1 and e2, or the parts along e1, e2 and e3. */
export type Direction = number | Place;

export interface CableState {
  name: string; tension: number; length: number; stroke: number;
  command?: { stroke: number; length: number; slack: boolean };
}

export type Profile = number | { base: number; tip: number } | [number, number][];

export interface Inputs {
  name: string;
  arm: {
    length: number; radius: Profile; density: number; space?: "planar" | "spatial";
    base: { x: number; y: number; angle?: number; z?: number; direction?: Place; section?: Place };
  };
  material: Record<string, Profile>;
  cable?: {
    name: string; offset: Profile; tension?: number; stroke?: number; max_tension?: number; end: number; friction?: number;
  }[];
  flow: { speed: number; direction: Direction; density: number; layer_thickness: number; law: string; cn?: number; ct?: number };
  gravity?: { acceleration: number; direction: Direction };
  tip: { force: number[]; moment: number | number[]; follower: number[] };
  model: Record<string, string>;
}

export interface Solution {
  converged: true; stable: boolean | null; warnings: Note[]; snaps: Snap[]; tip: Tip; stations: Stations; cables: CableState[]; base: Wrench;
  unmet?: Wrench; error_estimate: number; fold_margin: number; inputs: Inputs; statistics: Record<string, number>;
}

/** A jump of the tip: distance in m, angle in rad. */
export interface Snap { phase: string; load_fraction: number; before: Tip; after: Tip; distance: number; angle: number }

export interface Verdict {
  kind: string; phase: string; load_fraction: number; s: number | null; message: string; advice: string;
  other_equilibria: { count: number; stable: number; complete: boolean } | null;
  snaps: Snap[]; after_snap: Solution | null; at_full_loads: Solution | null;
}

export interface Failure { converged: false; verdict: Verdict; last_good: Solution | null }
export type Answer = Solution | Failure;

/** The layer of the stream at the stations: speed along the surface outside of it (m/s), the side that the stream meets, and the share of that
 * speed at equal distances from the surface. */
export interface Layer { speed: number[]; windward: (1 | -1)[]; profile: number[] }
export interface Drawing { radius: number[]; offsets: number[][]; offsets_c?: number[][]; tension_scale: number[]; layer?: Layer; crossing?: Point }
export interface Silhouette { x: number[]; y: number[]; theta?: number[]; z?: number[]; a?: Place[]; half_width: number[] }

/** A choice among words, of which the first is the default. */
export interface Choice { key: string; label: string; meaning: string; words: { word: string; meaning: string }[] }
export interface Options { readings: Choice[]; flow_law: Choice }

export interface Pulled {
  tensions: number[]; reached: boolean; distance: number; bounds: { cable: number; kind: "slack" | "most" }[];
  jumped: boolean; elsewhere: boolean;
}

/** The shape of a moving arm at one time (s), by the names of stations. */
export interface MotionShape {
  time: number; s: number[]; x: number[]; y: number[]; nu: number[]; eta: number[]; mu: number[];
  theta?: number[]; z?: number[]; a?: Place[]; b?: Place[]; c?: Place[]; zeta?: number[]; tau?: number[]; kappa?: number[];
}

/** A moving arm: energies and works in J, the hand's force in N, `inputs` with the present loads where they are others than before. */
export interface MotionReply {
  shape: MotionShape; beta: number[]; velocity: Place; cables: { tension: number; stroke: number }[];
  kinetic_energy: number; strain_energy: number; works: Record<string, number>; hand?: Place; error_estimate: number;
  events: { time: number; kind: string; cable: number | null; s: number | null }[]; warnings: Note[]; inputs?: Inputs; ramping: boolean;
  ended?: { kind: string; time: number; s: number | null; message: string };
}

/** What is asked of a moving arm: to begin, a piece of time (s), loads and how long they take (s), and where a hand is. */
export interface MotionWish {
  by: number; start?: boolean; loads?: Record<string, Setting>; within?: number; hold?: number[];
}

export interface Problem { kind: string; field: string | null; key: string | null; line: number | null; message: string }

export interface Reply {
  id: number; answer?: Answer; drawing?: Drawing; ghost?: Silhouette; pulled?: Pulled; motion?: MotionReply; error?: Problem; dropped: number;
  microseconds: number;
}

export type Setting = number | string;

export interface Wish {
  arm: ArmChoice; set: Record<string, Setting>; target?: number[]; max_tension?: number; stations?: number; motion?: MotionWish;
}

/** A shipped arm by its name, or the text of an arm file. */
export type ArmChoice = { name: string; toml?: undefined } | { name: string; toml: string };

export type Point = [number, number];
export type Place = [number, number, number];

/** A part of a surface in space as it is seen. */
export interface Patch { corners: Point[]; station: number; light: number }

/** A shape in the form that it is painted in, on the page, m; `tip` is the place of its tip. */
export interface Outline {
  left: Point[]; right: Point[]; centre: Point[]; cables: Point[][]; tip: Place;
  /** Of a shape in space: its surface, the furthest first, the edges of sections and what is seen of them, where cables are behind the centreline. */
  space?: {
    patches: () => Patch[]; ring: (station: number, wider?: number) => Point[]; arc: (station: number) => Point[]; hidden: boolean[][];
  };
}

/** What is painted of a shape, seen from where a camera is. */
export type Body = (camera: import("./camera.js").Camera) => Outline;

/** An answer that can be looked at: its shape, what draws it, and whether it is the one asked for. */
export interface Shown { shape: Solution; drawing: Drawing; body: Body; outline: Outline; asked: boolean }

export interface State {
  value: number; tip: Tip; event: string | null; cable: number | null;
  stability: { state: "stable" | "unstable" | "marginal" | null; directions: number | null };
}

export interface PathDocument {
  parameter: string; unit: string; range: [number, number];
  branches: { end: { kind: string; message: string }; points: State[] }[];
}

export interface EquilibriaDocument { complete: boolean; equilibria: State[]; shapes?: Silhouette[]; ends: ({ message: string } | null)[]; misses_some?: boolean; curves?: number }

// The form of the data in the page, as plan_cutters.report.page writes it. Lengths mm, angles degrees, part frame.

export type Vec = [number, number, number];
export type Pattern = "plain" | "hatch" | "dots" | "cross" | "bars" | "lines" | "back";
export type PartName = "flutes" | "neck" | "shank" | "holder";

export interface Face {
  number: number;
  id: string;
  name: string;
  component: string;
  surface: string;
  target: boolean;
  ignored: boolean;
  area_mm2: number;
  start: number;
  count: number;
}

export interface Fixture {
  name: string;
  start: number;
  count: number;
  /** Setups in which it stands, counted from 0. */
  setups: number[];
}

/** Where a cutter touches: on the circle `offset` from its axis and `height` over its tip, with a radius of curvature. */
export interface Mode {
  offset: number;
  radius: number;
  height: number;
  tilt_low_deg: number;
  tilt_high_deg: number;
}

export interface Outline {
  part: PartName;
  points: [number, number][];
}

export interface Cutter {
  id: string;
  name: string;
  feasible: boolean | null;
  radius: number;
  corner_radius: number;
  allowance_mm: number;
  clearance_mm: number;
  touches_deg: [number, number][];
  modes: Mode[];
  outline: Outline[];
  has_posture: boolean;
}

export interface Spot {
  cutter: string;
  sample: number;
  face: string;
  reason: string;
  point: Vec;
  obstacle_face: string | null;
  obstacle_point: Vec | null;
  depth_mm: number | null;
  tilt_deg: number | null;
  lean_deg: number | null;
  axis: Vec | null;
  text: string;
}

export interface Scalar {
  key: string;
  label: string;
  unit: string;
  low: number | null;
  high: number | null;
  array: string;
  column: number | null;
}

/** An operation of a plan: one cutter in one setup, with one tool axis or, where that is null, simultaneous motion. */
export interface Operation {
  label: string;
  /** Its angles, degrees. */
  turned: string;
  cutter: string;
  setup: number;
  axis: Vec | null;
  colour: string;
  pattern: Pattern;
  text: string;
  /** Where its tool is shown. */
  sample: number | null;
  /** Words of a control for its orientation: the tilted plane and the turn onto it, or the rotary axes. */
  words: string[];
}

export interface OperationPlan {
  key: string;
  name: string;
  array: string;
  lean: string;
  operations: Operation[];
}

/** A step of the process: one cutter in one setup; `axis` is null where each sample has a posture of its own. */
export interface Step {
  label: string;
  cutter: string;
  setup: number;
  axis: Vec | null;
  colour: string;
  pattern: Pattern;
  share: number;
  text: string;
  /** Where its tool is shown. */
  sample: number | null;
}

export interface Process {
  /** The plan of operations that it is; empty: none. */
  plan: string;
  left_share: number;
  /** How the part stands in each setup, and what holds it. */
  setups: string[];
  steps: Step[];
}

export interface ArrayEntry {
  dtype: "u1" | "u2" | "u4" | "i2" | "i4" | "f2";
  shape: number[];
  filter: string;
  offset: number;
  bytes: number;
}

/** Rotary axes from the part to the tool, in the part's frame; null: no limit that way. */
export interface Kinematics {
  direction: Vec[];
  limit_deg: [number | null, number | null][];
  /** Where the tool points at zero angles. */
  tool: Vec;
}

export interface Meta {
  format: number;
  part: { file: string; sha256: string; size_mm: Vec; low: Vec; high: Vec };
  setup: { z: Vec; x: Vec | null };
  machine: string;
  tolerance_mm: number;
  /** Depths up to this in the drawn triangles, mm, are no gouge for certain. */
  overlooked_mm: number;
  shown: string;
  selected: string | null;
  reasons: string[];
  verdicts: Record<string, string>;
  /** Verdicts and what is no target, as they are called, and their colours. */
  words: Record<string, { name: string; colour: string }>;
  /** Reasons, and why a posture map has nothing at a tilt: the table of the plan's story. */
  causes: Record<string, { name: string; sentence: string; colour: string; pattern: Pattern }>;
  rotation_deg: number[];
  tilt_deg: [number, number];
  tilt_limit_deg: number | null;
  rotary: boolean;
  /** Names of the rotary axes, the one next to the part first. */
  axes: string[];
  kinematics: Kinematics | null;
  /** Where there are several: each, the first one first. */
  setups: { z: Vec; kinematics: Kinematics | null }[];
  atlas: [number, number] | null;
  faces: Face[];
  fixtures: Fixture[];
  cutters: Cutter[];
  spots: Spot[];
  scalars: Scalar[];
  operations: null | { plans: OperationPlan[] };
  process: Process | null;
  arrays: Record<string, ArrayEntry>;
}

export const NO_REASON = 255;
export const NO_SETUP = 255;

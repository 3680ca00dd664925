// Which step or operation takes a sample, and how its tool stands there.

import type { Arrays } from "./decode.ts";
import type { Meta, OperationPlan, Vec } from "./meta.ts";
import { type Posture, type Sample, shareOf } from "./samples.ts";
import { cross, DEG, dot, turned } from "./vectors.ts";

const MODE = "operation:";

/** The colouring by the steps of the process, which may be a plan of operations. */
export const PROCESS = "process";

/** What the picture shows first. */
export const firstMode = ({ process }: Meta): string => (process ? PROCESS : "verdict");

/** The colouring of a plan. */
export const modeOf = (meta: Meta, plan: OperationPlan): string => (plan.key === meta.process?.plan ? PROCESS : MODE + plan.key);

export const titleOf = ({ name }: OperationPlan): string => `${name.charAt(0).toUpperCase()}${name.slice(1)} operations`;

export const plansOf = (meta: Meta): OperationPlan[] => meta.operations?.plans ?? [];

/** The plan that a colouring shows; null for other colourings. */
export const planOf = (meta: Meta, mode: string): OperationPlan | null =>
  plansOf(meta).find((plan) => modeOf(meta, plan) === mode) ?? null;

/** The plans of operations beside the process. */
export const othersOf = (meta: Meta): OperationPlan[] => plansOf(meta).filter((plan) => modeOf(meta, plan) !== PROCESS);

/** The number of the step that finishes a sample, 0 for none. */
export function stepOf(arrays: Arrays): (row: number) => number {
  const { values } = arrays.get("step");
  return (row) => values[row];
}

/** The place in a plan of the operation that takes a sample, -1 for none. */
export function takenBy(plan: OperationPlan, arrays: Arrays): (row: number) => number {
  const { values } = arrays.get(plan.array);
  return (row) => values[row] - 1;
}

/** Axes nearer to the normal may stand upright: the posture says where under the tool the sample is, degrees. */
const UPRIGHT = 1;

/** The posture of a tool axis at a sample that an operation of a plan takes. */
export function postureOf(plan: OperationPlan, arrays: Arrays, axis: Vec, sample: Sample): Posture {
  const side = cross(sample.normal, sample.direction);
  const tilt = Math.acos(Math.min(1, Math.max(-1, dot(axis, sample.normal)))) * DEG;
  const lean = Math.atan2(dot(axis, side), dot(axis, sample.direction)) * DEG;
  if (tilt >= UPRIGHT) return { tilt, rotation: turned(lean) };
  const rotation = turned(arrays.get(plan.lean).values[sample.row] / 100);
  return { tilt, rotation, ...shareOf(arrays, `operation_share.${plan.key}`, sample.row) };
}

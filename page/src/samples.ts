// A sample: where it lies, its frame, its curvature, and what a cutter reaches there.

import type { Arrays, Table } from "./decode.ts";
import type { Meta, Vec } from "./meta.ts";
import { NO_REASON, NO_SETUP } from "./meta.ts";
import { across, apart, cross, mixed, octahedral, RAD, turned } from "./vectors.ts";

export interface Sample {
  row: number;
  point: Vec;
  normal: Vec;
  /** Direction of the largest curvature, from which rotations count. */
  direction: Vec;
  /** Largest and least, 1/mm, concave positive. */
  curvature: [number, number];
  face: number;
}

export interface Posture {
  tilt: number;
  rotation: number;
  /** Upright, how far the contact is from the axis, as a share of the radius of the flat tip; not given: at its rim. */
  share?: number;
  /** From the sample to where the tool is put down, mm: where a flank, or a flat that is not quite square, lies on the face. */
  shift?: Vec;
}

/** Shares are stored in so many parts. */
export const SHARES = 10000;

/** Whether two postures are one, but for the rounding of stored ones. */
export const alike = (a: Posture, b: Posture): boolean =>
  Math.abs(a.tilt - b.tilt) < 0.02 && apart(a.rotation, b.rotation) < 0.02;

/** The share of a sample's posture, where some are stored. */
export const shareOf = (arrays: Arrays, name: string, row: number): { share?: number } =>
  arrays.has(name) ? { share: arrays.get(name).values[row] / SHARES } : {};

export class Samples {
  readonly count: number;
  readonly face: Table;
  readonly surfaceClass: Table;

  constructor(private readonly meta: Meta, private readonly arrays: Arrays) {
    this.face = arrays.get("sample.face");
    this.surfaceClass = arrays.get("sample.class");
    this.count = this.face.rows;
  }

  at(row: number): Sample {
    const point = this.point(row);
    const normal = this.normal(row);
    const angle = (this.arrays.get("sample.direction").values[row] / 32767) * Math.PI;
    const first = across(normal);
    const direction = mixed(first, Math.cos(angle), cross(normal, first), Math.sin(angle));
    const bends = this.arrays.get("sample.curvature");
    return {
      row,
      point,
      normal,
      direction,
      curvature: [bends.values[row], bends.values[bends.rows + row]],
      face: this.face.values[row],
    };
  }

  /** The place of a sample in decimals that are known: points are stored to a 65535th of the part. */
  told(row: number): number[] {
    const { low, high } = this.meta.part;
    const step = Math.max(...[0, 1, 2].map((k) => high[k] - low[k])) / 65535;
    const digits = Math.min(20, Math.max(0, Math.floor(-Math.log10(step || 1))));
    return this.point(row).map((x) => Number(x.toFixed(digits)));
  }

  point(row: number): Vec {
    const { rows, values } = this.arrays.get("sample.point");
    const { low, high } = this.meta.part;
    return [0, 1, 2].map((k) => low[k] + ((high[k] - low[k]) * values[k * rows + row]) / 65535) as Vec;
  }

  normal(row: number): Vec {
    const { rows, values } = this.arrays.get("sample.normal");
    return octahedral(values[row] / 32767, values[rows + row] / 32767);
  }

  /** What a sample stands for, mm2. */
  area(row: number): number {
    const { values } = this.arrays.get("sample.area");
    return Number.isFinite(values[row]) ? values[row] : 0;
  }

  verdicts(cutter: string): Table {
    return this.arrays.get(`verdict.${cutter}`);
  }

  reasons(cutter: string): Table {
    return this.arrays.get(`reason.${cutter}`);
  }

  /** Whether it lies inside another body of the part: no surface of the finished part. */
  inside(row: number): boolean {
    return this.arrays.has("sample.inside") && this.arrays.get("sample.inside").values[row] === 1;
  }

  /** The setup whose posture a sample has, counted from 0; null where none serves it. */
  setup(cutter: string, row: number): number | null {
    if (!this.arrays.has(`setup.${cutter}`)) return 0;
    const found = this.arrays.get(`setup.${cutter}`).values[row];
    return found === NO_SETUP ? null : found;
  }

  verdict(cutter: string, row: number): string {
    if (this.inside(row)) return "inside_bodies";
    return this.meta.verdicts[String(this.verdicts(cutter).values[row])] ?? "unjudged";
  }

  reason(cutter: string, row: number): string | null {
    const found = this.reasons(cutter).values[row];
    return found === NO_REASON ? null : (this.meta.reasons[found] ?? null);
  }

  /** The posture found, degrees; null where there is none, or where it is not stored for this cutter. */
  posture(cutter: string, row: number): Posture | null {
    if (!this.arrays.has(`tilt.${cutter}`)) return null;
    const tilt = this.arrays.get(`tilt.${cutter}`).values[row];
    if (tilt === 65535) return null;
    const posture = { tilt: tilt / 100, rotation: turned(this.arrays.get(`lean.${cutter}`).values[row] / 100) };
    if (tilt === 0) return { ...posture, ...shareOf(this.arrays, `share.${cutter}`, row) };
    return { ...posture, ...this.shiftOf(`shift.${cutter}`, row) };
  }

  private shiftOf(name: string, row: number): { shift?: Vec } {
    if (!this.arrays.has(name)) return {};
    const { rows, values } = this.arrays.get(name);
    return { shift: [values[row], values[rows + row], values[2 * rows + row]] };
  }

  /** The lean direction at a rotation, degrees. */
  static lean(sample: Sample, rotation: number): Vec {
    const across_ = cross(sample.normal, sample.direction);
    return mixed(sample.direction, Math.cos(rotation * RAD), across_, Math.sin(rotation * RAD));
  }
}

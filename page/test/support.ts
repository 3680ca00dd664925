// What the tests share: numbers drawn from a seed, a closeness of numbers, samples and cutters.

import assert from "node:assert/strict";
import type { Cutter, Vec } from "../src/meta.ts";
import type { Sample } from "../src/samples.ts";
import { cross, dot, minus, mixed, norm, plus, scaled, unit } from "../src/vectors.ts";

/** Numbers from 0 to 1, the same at each run (mulberry32). */
export function numbers(seed: number): () => number {
  let a = seed;
  return () => {
    a = (a + 0x6d2b79f5) | 0;
    let t = Math.imul(a ^ (a >>> 15), 1 | a);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

export const between = (random: () => number, low: number, high: number): number => low + (high - low) * random();

export function direction(random: () => number): Vec {
  for (;;) {
    const v: Vec = [between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)];
    if (norm(v) > 0.1 && norm(v) < 1) return unit(v);
  }
}

export function close(a: number, b: number, most: number, what = ""): void {
  assert.ok(Math.abs(a - b) <= most, `${what} ${a} and ${b} differ by more than ${most}`);
}

/** A vector turned about a unit direction, by Rodrigues' formula. */
export function rotated(v: Vec, about: Vec, angle: number): Vec {
  const flat = plus(scaled(v, Math.cos(angle)), cross(about, v), Math.sin(angle));
  return plus(flat, about, dot(about, v) * (1 - Math.cos(angle)));
}

export function sampleAt(random: () => number, curvature: [number, number] = [0, 0]): Sample {
  const normal = direction(random);
  const raw = direction(random);
  const first = unit(minus(raw, scaled(normal, dot(raw, normal))));
  return { row: 0, point: scaled(direction(random), 10), normal, direction: first, curvature, face: 0 };
}

export const floor: Sample = { row: 0, point: [0, 0, 0], normal: [0, 0, 1], direction: [1, 0, 0], curvature: [0, 0], face: 0 };

/** An end mill with a corner radius: flat with none, a ball where it is the radius. */
export function endMill(radius: number, corner: number, length: number): Cutter {
  const points: [number, number][] = [[0, 0]];
  const offset = radius - corner;
  for (let k = 0; k <= 64; k++) {
    const angle = (k / 64) * (Math.PI / 2);
    points.push([offset + corner * Math.sin(angle), corner - corner * Math.cos(angle)]);
  }
  points.push([radius, length], [0, length]);
  return {
    id: "tool", name: "", feasible: null, radius, corner_radius: corner, allowance_mm: 0, clearance_mm: 0, touches_deg: [[0, 180]],
    modes: [{ offset, radius: corner, height: corner, tilt_low_deg: 0, tilt_high_deg: 180 }],
    outline: [{ part: "flutes", points }], has_posture: true,
  };
}

/** The part of a vector across a unit direction, as a length. */
export const away = (v: Vec, axis: Vec): number => norm(mixed(v, 1, axis, -dot(v, axis)));

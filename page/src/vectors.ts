// Vectors of three numbers, as plain arrays.

import type { Vec } from "./meta.ts";

export const dot = (a: Vec, b: Vec): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const plus = (a: Vec, b: Vec, times = 1): Vec => [a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]];
export const minus = (a: Vec, b: Vec): Vec => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scaled = (a: Vec, by: number): Vec => [a[0] * by, a[1] * by, a[2] * by];
export const mixed = (a: Vec, x: number, b: Vec, y: number): Vec => plus(scaled(a, x), b, y);
export const norm = (a: Vec): number => Math.hypot(a[0], a[1], a[2]);
export const cross = (a: Vec, b: Vec): Vec => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const distance = (a: Vec, b: Vec): number => norm(minus(a, b));

/** Along axis k. */
export const axis = (k: number, size = 1): Vec => [0, 1, 2].map((i) => (i === k ? size : 0)) as Vec;

export function unit(a: Vec): Vec {
  const length = norm(a);
  return length > 0 ? scaled(a, 1 / length) : [0, 0, 1];
}

/** A unit vector across a unit vector: with the axis along which that is shortest, the first of equals. */
export function across(n: Vec): Vec {
  const size = n.map(Math.abs);
  const k = size.indexOf(Math.min(...size));
  return unit(cross(axis(k), n));
}

/** The direction of two octahedral coordinates, each -1 to 1. */
export function octahedral(x: number, y: number): Vec {
  const z = 1 - Math.abs(x) - Math.abs(y);
  const u = z < 0 ? (1 - Math.abs(y)) * (x < 0 ? -1 : 1) : x;
  const v = z < 0 ? (1 - Math.abs(x)) * (y < 0 ? -1 : 1) : y;
  // In the very steps in which the data were written: the frames of tangents must be the same.
  const length = Math.sqrt(u * u + v * v + z * z);
  return [u / length, v / length, z / length];
}

export const RAD = Math.PI / 180;
export const DEG = 180 / Math.PI;
/** An angle in degrees, 0 up to 360. */
export const turned = (deg: number): number => ((deg % 360) + 360) % 360;
/** How far apart two angles in degrees are. */
export const apart = (a: number, b: number): number => Math.abs(((a - b + 540) % 360) - 180);

// Whether a triangle reaches into a part of a tool, a stack of cones about its axis: exact for each cone but for rounding.

import type { Outline } from "./meta.ts";

/** Cones from the tip up, `CONE` numbers each; heights over the tip. */
export interface Solid {
  part: Outline["part"];
  cones: Float64Array;
  low: number;
  high: number;
  widest: number;
}

/** Numbers of a cone: its heights from and to, and its radii there. */
const CONE = 4;

/** A part made smaller all round by `inset` (larger where that is negative). */
export function solidOf(outline: Outline, inset: number): Solid {
  const moved = shifted(outline.points, inset);
  const found: number[] = [];
  for (let i = 0; i + 1 < moved.length; i++) {
    let [[r0, h0], [r1, h1]] = [moved[i], moved[i + 1]];
    if (h1 - h0 < 1e-9 || (r0 <= 0 && r1 <= 0)) continue;
    // Cut off where the cone comes to its point.
    if (r0 < 0) [r0, h0] = [0, h0 + ((h1 - h0) * -r0) / (r1 - r0)];
    if (r1 < 0) [r1, h1] = [0, h0 + ((h1 - h0) * r0) / (r0 - r1)];
    found.push(h0, h1, r0, r1);
  }
  const cones = new Float64Array(found);
  let [low, high, widest] = [Infinity, -Infinity, 0];
  for (let i = 0; i < cones.length; i += CONE) {
    low = Math.min(low, cones[i]);
    high = Math.max(high, cones[i + 1]);
    widest = Math.max(widest, cones[i + 2], cones[i + 3]);
  }
  return { part: outline.part, cones, low, high, widest };
}

/** A polyline whose sides are moved to their left by `inset`: into the tool. */
function shifted(points: [number, number][], inset: number): [number, number][] {
  const kept = points.filter((p, i) => i === 0 || Math.hypot(p[0] - points[i - 1][0], p[1] - points[i - 1][1]) > 1e-9);
  const normals = kept.slice(1).map(([r, h], i) => {
    const [dr, dh] = [r - kept[i][0], h - kept[i][1]];
    const length = Math.hypot(dr, dh);
    return [-dh / length, dr / length];
  });
  return kept.map(([r, h], i) => {
    const a = normals[Math.max(0, i - 1)];
    const b = normals[Math.min(normals.length - 1, i)];
    if (!a || !b) return [r, h];
    // The corner of two moved sides; nearly opposite sides have none.
    const share = inset / Math.max(0.2, 1 + a[0] * b[0] + a[1] * b[1]);
    return [r + share * (a[0] + b[0]), h + share * (a[1] + b[1])];
  });
}

const u = new Float64Array(8);
const v = new Float64Array(8);
const w = new Float64Array(8);
const u2 = new Float64Array(8);
const v2 = new Float64Array(8);
const w2 = new Float64Array(8);

/** Where the last triangle reached in, in the tool's frame, and how far within the side that point is, mm. */
export const hit = { x: 0, y: 0, h: 0, depth: 0 };

/**
 * Whether a triangle, nine numbers in the tool's frame (two across the axis, one the height over the tip), reaches into a
 * solid. Then `hit` is a point of it there: any, or if `thorough` the one found that lies deepest within a side.
 */
export function reaches(solid: Solid, t: Float64Array, thorough: boolean): boolean {
  const bottom = Math.min(t[2], t[5], t[8]);
  const top = Math.max(t[2], t[5], t[8]);
  hit.depth = 0;
  if (bottom >= solid.high || top <= solid.low) return false;
  const { cones } = solid;
  for (let i = 0; i < cones.length; i += CONE) {
    if (bottom >= cones[i + 1] || top <= cones[i]) continue;
    look(cones[i], cones[i + 1], cones[i + 2], cones[i + 3], t, bottom, top);
    if (hit.depth > 0 && !thorough) return true;
  }
  return hit.depth > 0;
}

function look(h0: number, h1: number, r0: number, r1: number, t: Float64Array, bottom: number, top: number): void {
  const slope = (r1 - r0) / (h1 - h0);
  let count = 3;
  for (let k = 0; k < 3; k++) {
    u[k] = t[3 * k];
    v[k] = t[3 * k + 1];
    w[k] = t[3 * k + 2];
  }
  if (bottom < h0) count = cut(count, h0, 1);
  if (top > h1 && count) count = cut(count, h1, -1);
  if (count < 2) return;
  let positive = 0;
  let negative = 0;
  for (let k = 0; k < count; k++) {
    const j = k + 1 === count ? 0 : k + 1;
    const du = u[j] - u[k];
    const dv = v[j] - v[k];
    const dr = slope * (w[j] - w[k]);
    const r = r0 + slope * (w[k] - h0);
    const a = du * du + dv * dv - dr * dr;
    const b = u[k] * du + v[k] * dv - r * dr;
    // Deepest in the cone: within the edge, or at its start.
    const s = a > 0 ? Math.min(1, Math.max(0, -b / a)) : 0;
    note(u[k] + s * du, v[k] + s * dv, w[k] + s * (w[j] - w[k]), r + s * dr);
    const turn = u[k] * dv - v[k] * du;
    if (turn > 0) positive++;
    else if (turn < 0) negative++;
  }
  if (positive + negative > 0 && (positive === 0 || negative === 0)) atAxis(t, h0, h1, r0, slope);
}

function note(x: number, y: number, h: number, r: number): void {
  const depth = r - Math.sqrt(x * x + y * y);
  if (depth > hit.depth) {
    hit.x = x;
    hit.y = y;
    hit.h = h;
    hit.depth = depth;
  }
}

/** The axis goes through the triangle: so does the cone, if it does at one of its heights. */
function atAxis(t: Float64Array, h0: number, h1: number, r0: number, slope: number): void {
  const d = (t[3] - t[0]) * (t[7] - t[1]) - (t[6] - t[0]) * (t[4] - t[1]);
  if (d === 0) return;
  const a = (-t[0] * (t[7] - t[1]) + (t[6] - t[0]) * t[1]) / d;
  const b = (-(t[3] - t[0]) * t[1] + t[0] * (t[4] - t[1])) / d;
  const h = t[2] + a * (t[5] - t[2]) + b * (t[8] - t[2]);
  if (h >= h0 && h <= h1) note(0, 0, h, r0 + slope * (h - h0));
}

/** Keep what lies above (`way` 1) or below (-1) a height. */
function cut(count: number, height: number, way: number): number {
  let n = 0;
  for (let k = 0; k < count; k++) {
    const j = k + 1 === count ? 0 : k + 1;
    const here = way * (w[k] - height);
    const next = way * (w[j] - height);
    if (here >= 0) {
      u2[n] = u[k];
      v2[n] = v[k];
      w2[n++] = w[k];
    }
    if (here >= 0 !== next >= 0) {
      const s = here / (here - next);
      u2[n] = u[k] + s * (u[j] - u[k]);
      v2[n] = v[k] + s * (v[j] - v[k]);
      w2[n++] = height;
    }
  }
  for (let k = 0; k < n; k++) {
    u[k] = u2[k];
    v[k] = v2[k];
    w[k] = w2[k];
  }
  return n;
}

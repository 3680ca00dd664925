import assert from "node:assert/strict";
import { test } from "node:test";
import { hit, reaches, solidOf } from "../src/overlap.ts";
import { between, close, numbers } from "./support.ts";

const points: [number, number][] = [[0, 0], [2, 0.5], [3, 6], [1.5, 9], [1.5, 14], [0, 14]];
const solid = solidOf({ part: "flutes", points }, 0);

/** The outline's radius at a height, from its own points; -1 beyond its ends. */
function radius(h: number): number {
  for (let i = 0; i + 1 < points.length; i++) {
    const [[r0, h0], [r1, h1]] = [points[i], points[i + 1]];
    if (h >= h0 && h <= h1 && h1 > h0) return r0 + ((r1 - r0) * (h - h0)) / (h1 - h0);
  }
  return -1;
}

const depth = (x: number, y: number, h: number): number => radius(h) - Math.hypot(x, y);

test("a triangle reaches in just where a point of it lies inside", () => {
  const random = numbers(21);
  let [inside, outside] = [0, 0];
  for (let k = 0; k < 1500; k++) {
    const t = new Float64Array(9).map((_, i) => (i % 3 === 2 ? between(random, -3, 17) : between(random, -6, 6)));
    const thorough = k % 2 === 0;
    const met = reaches(solid, t, thorough);
    let deepest = -Infinity;
    for (let i = 0; i <= 40; i++) {
      for (let j = 0; j <= 40 - i; j++) {
        const [a, b] = [i / 40, j / 40];
        const [x, y, h] = [0, 1, 2].map((c) => (1 - a - b) * t[c] + a * t[3 + c] + b * t[6 + c]);
        deepest = Math.max(deepest, depth(x, y, h));
      }
    }
    if (deepest > 1e-9) assert.ok(met, `a point lies ${deepest} inside`);
    if (!met) {
      outside++;
      continue;
    }
    inside++;
    // What it names is a point of the triangle, inside.
    close(depth(hit.x, hit.y, hit.h), hit.depth, 1e-9, "depth");
    assert.ok(hit.depth > 0);
    close(offPlane(t), 0, 1e-6, "off the triangle's plane");
  }
  assert.ok(inside > 200 && outside > 200, `${inside} ${outside}`);
});

function offPlane(t: Float64Array): number {
  const e = [0, 1, 2].map((c) => t[3 + c] - t[c]);
  const f = [0, 1, 2].map((c) => t[6 + c] - t[c]);
  const n = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
  const size = Math.hypot(...n);
  return size === 0 ? 0 : ((hit.x - t[0]) * n[0] + (hit.y - t[1]) * n[1] + (hit.h - t[2]) * n[2]) / size;
}

test("a solid made smaller by an inset is as far within on all sides", () => {
  const cylinder: [number, number][] = [[0, 0], [5, 0], [5, 20], [0, 20]];
  for (const inset of [0.25, -0.25]) {
    const made = solidOf({ part: "flutes", points: cylinder }, inset);
    close(made.low, inset, 1e-12);
    close(made.high, 20 - inset, 1e-12);
    close(made.widest, 5 - inset, 1e-12);
  }
});

test("what is smaller than the inset leaves nothing", () => {
  const thin = solidOf({ part: "neck", points: [[0.1, 0], [0.1, 5]] }, 0.2);
  assert.equal(thin.cones.length, 0);
  assert.ok(!reaches(thin, new Float64Array([-1, 0, 1, 1, 0, 1, 0, 1, 4]), true));
});

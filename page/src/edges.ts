// The borders of faces, as thin lines: a part reads better with them.

import { BufferAttribute, BufferGeometry, LineSegments } from "./three";
import type { Drawn } from "./mesh.ts";
import { plainMaterial } from "./shading.ts";

/** Edges of triangles that no other triangle of the same face shares. */
export function borders(drawn: Drawn): LineSegments {
  const { triangle, position } = drawn;
  const seen = new Map<number, number>();
  const count = position.length / 3;
  const same = coincident(drawn);
  for (let t = 0; t < triangle.length; t += 3) {
    for (let k = 0; k < 3; k++) {
      const a = same[triangle[t + k]];
      const b = same[triangle[t + ((k + 1) % 3)]];
      if (a === b) continue;
      const key = Math.min(a, b) * count + Math.max(a, b);
      seen.set(key, (seen.get(key) ?? 0) + 1);
    }
  }
  const ends: number[] = [];
  for (const [key, times] of seen) if (times === 1) ends.push(Math.floor(key / count), key % count);
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(position, 3));
  geometry.setIndex(ends);
  const lines = new LineSegments(geometry, plainMaterial("0.09, 0.11, 0.13, 0.75", { transparent: true }));
  lines.renderOrder = 0.5;
  return lines;
}

/** Of each vertex the first one of its face at the same place: triangles of some faces share no vertices. */
function coincident({ cell, owner }: Drawn): Int32Array {
  const same = new Int32Array(owner.length);
  let [of, first] = [Number.NaN, new Map<number, number>()];
  for (let i = 0; i < owner.length; i++) {
    // Vertices of a face follow each other.
    if (owner[i] !== of) [of, first] = [owner[i], new Map()];
    const known = first.get(cell[i]);
    same[i] = known ?? i;
    if (known === undefined) first.set(cell[i], i);
  }
  return same;
}

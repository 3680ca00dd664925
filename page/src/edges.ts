// The borders of faces, as thin lines: a part reads better with them.

import { BufferAttribute, BufferGeometry, LineSegments } from "./three";
import type { Drawn, Owner } from "./mesh.ts";
import { plainMaterial } from "./shading.ts";

/** The lines of a part and its fixtures; those of what is hidden are not drawn. */
export class Borders {
  readonly lines: LineSegments;
  /** Runs of line ends by owner, in order. */
  private readonly runs: [Owner, number, number][] = [];

  constructor(private readonly drawn: Drawn) {
    const { position, owner } = drawn;
    const ends = borderEnds(drawn);
    ends.forEach((end, i) => {
      const last = this.runs[this.runs.length - 1];
      if (last?.[0] === owner[end]) last[2] = i + 1 - last[1];
      else this.runs.push([owner[end], i, 1]);
    });
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(position, 3));
    geometry.setIndex(ends);
    this.lines = new LineSegments(geometry, [plainMaterial("0.09, 0.11, 0.13, 0.75", { transparent: true })]);
    this.lines.renderOrder = 0.5;
    this.look();
  }

  /** Draw the lines of what is seen now. */
  look(): void {
    showRuns(this.lines.geometry, this.runs, (owner) => this.drawn.seen(owner));
  }
}

/** Let a geometry draw those of its runs (owner, first index, count) that are wanted; what follows each other in one go. */
export function showRuns(geometry: BufferGeometry, runs: readonly [Owner, number, number][], wanted: (owner: Owner) => boolean): void {
  const groups: { start: number; count: number }[] = [];
  for (const [owner, start, count] of runs) {
    if (!count || !wanted(owner)) continue;
    const last = groups[groups.length - 1];
    if (last && last.start + last.count === start) last.count += count;
    else groups.push({ start, count });
  }
  geometry.clearGroups();
  for (const { start, count } of groups) geometry.addGroup(start, count, 0);
}

/** Ends of the edges of triangles that no other triangle of the same face shares, two a line. */
function borderEnds(drawn: Drawn): number[] {
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
  return ends;
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

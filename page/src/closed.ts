// Whether a mesh encloses something, so that a section through it has an inside: looked at from many points, the number of
// surfaces that a ray meets is odd in every direction or in none. Small cracks between faces do not matter to that, as they do
// not to a picture.

import { DoubleSide, Ray, Vector3 } from "./three";
import type { Drawn, Owner } from "./mesh.ts";

const POINTS = 400;
/** Share of the points within that may be told otherwise by one of the rays. */
const DOUBTFUL = 0.04;
const WAYS = [
  [0.437, 0.771, 0.463],
  [-0.623, 0.217, 0.751],
  [0.283, -0.859, -0.427],
].map(([x, y, z]) => new Vector3(x, y, z).normalize());

/** Whether the triangles of some owners enclose something. */
export function closed(drawn: Drawn, wanted: (owner: Owner) => boolean): boolean {
  const { low, high } = drawn.meta.part;
  let [within, doubtful] = [0, 0];
  for (let i = 1; i <= POINTS; i++) {
    const at = [2, 3, 5].map((base, k) => low[k] + (high[k] - low[k]) * spread(i, base));
    const odd = WAYS.map((way) => {
      const hits = drawn.tree.raycast(new Ray(new Vector3(...at), way), DoubleSide);
      return hits.filter(({ face }) => face && wanted(drawn.owner[face.a])).length % 2;
    });
    const count = odd.reduce((sum, each) => sum + each, 0);
    within += count > 0 ? 1 : 0;
    doubtful += count > 0 && count < WAYS.length ? 1 : 0;
  }
  return doubtful <= Math.max(1, DOUBTFUL * within);
}

/** The i-th of evenly spread numbers between 0 and 1 (radical inverse). */
function spread(i: number, base: number): number {
  let [found, share] = [0, 1 / base];
  for (let rest = i; rest > 0; rest = Math.floor(rest / base)) {
    found += (rest % base) * share;
    share /= base;
  }
  return found;
}

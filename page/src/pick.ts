// What lies under the pointer: the point of the surface, its face or fixture, and the nearest sample.

import { DoubleSide, Raycaster, Vector2 } from "three";
import type { Drawn, Owner } from "./mesh.ts";
import type { Vec } from "./meta.ts";
import type { PartView } from "./part.ts";
import { shared } from "./shading.ts";
import type { Stage } from "./stage.ts";

export interface Picked {
  point: Vec;
  owner: Owner;
  sample: number | null;
}

export class Picker {
  private readonly caster = new Raycaster();

  constructor(
    private readonly stage: Stage,
    private readonly drawn: Drawn,
    private readonly part: PartView,
  ) {}

  /** What is seen at a place of the picture, -1 to 1 each way; null where nothing is. */
  at(x: number, y: number): Picked | null {
    this.caster.setFromCamera(new Vector2(x, y), this.stage.table.camera);
    const plane = shared.plane.value;
    const found = this.drawn.tree
      .raycast(this.caster.ray, DoubleSide)
      .filter(({ point }) => plane.x * point.x + plane.y * point.y + plane.z * point.z <= plane.w)
      .sort((a, b) => a.distance - b.distance)[0];
    if (!found?.face) return null;
    const { a, b, c } = found.face;
    const point: Vec = [found.point.x, found.point.y, found.point.z];
    const [s, t, u] = this.shares(point, a, b, c);
    const { texel } = this.drawn;
    const at = (k: number): number => s * texel[2 * a + k] + t * texel[2 * b + k] + u * texel[2 * c + k];
    return { point, owner: this.drawn.owner[a], sample: texel[2 * a] < 0 ? null : this.part.sampleAt(at(0), at(1)) };
  }

  /** Barycentric coordinates of a point of a triangle. */
  private shares(p: Vec, a: number, b: number, c: number): [number, number, number] {
    const [A, B, C] = [a, b, c].map((i) => this.drawn.vertex(i));
    const sub = (x: Vec, y: Vec): Vec => [x[0] - y[0], x[1] - y[1], x[2] - y[2]];
    const dot = (x: Vec, y: Vec): number => x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    const [e, f, g] = [sub(B, A), sub(C, A), sub(p, A)];
    const [ee, ef, ff, ge, gf] = [dot(e, e), dot(e, f), dot(f, f), dot(g, e), dot(g, f)];
    const det = ee * ff - ef * ef;
    if (det <= 0) return [1, 0, 0];
    const t = (ff * ge - ef * gf) / det;
    const u = (ee * gf - ef * ge) / det;
    return [1 - t - u, t, u];
  }
}

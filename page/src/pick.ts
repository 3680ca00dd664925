// What lies under the pointer: the point of the surface, its face or fixture, and the nearest sample.

import { DoubleSide, Ray, Raycaster, Triangle, Vector2, Vector3 } from "./three";
import type { Drawn, Owner } from "./mesh.ts";
import type { Vec } from "./meta.ts";
import type { PartView } from "./part.ts";
import { shared } from "./shading.ts";
import type { Stage } from "./stage.ts";
import { plus } from "./vectors.ts";

export interface Picked {
  point: Vec;
  owner: Owner;
  sample: number | null;
}

export class Picker {
  private readonly caster = new Raycaster();

  constructor(private readonly stage: Stage, private readonly drawn: Drawn, private readonly part: PartView) {}

  /** What is seen at a place of the picture, -1 to 1 each way; null where nothing is. */
  at(x: number, y: number): Picked | null {
    this.caster.setFromCamera(new Vector2(x, y), this.stage.table.camera);
    const plane = shared.plane.value;
    const found = this.drawn.tree
      .raycast(this.caster.ray, DoubleSide)
      .filter(({ face, point }) => face && this.drawn.solid(this.drawn.owner[face.a]) && plane.x * point.x + plane.y * point.y + plane.z * point.z <= plane.w)
      .sort((a, b) => a.distance - b.distance)[0];
    if (!found?.face) return null;
    const { a, b, c } = found.face;
    const { position, texel } = this.drawn;
    const [A, B, C] = [a, b, c].map((i) => new Vector3().fromArray(position, 3 * i));
    const share = Triangle.getBarycoord(found.point, A, B, C, new Vector3()) ?? new Vector3(1, 0, 0);
    const [s, t, u] = share.toArray();
    const at = (k: number): number => s * texel[2 * a + k] + t * texel[2 * b + k] + u * texel[2 * c + k];
    return { point: found.point.toArray(), owner: this.drawn.owner[a], sample: texel[2 * a] < 0 ? null : this.part.sampleAt(at(0), at(1)) };
  }

  /** Whether something that is not seen through lies between a point of the surface and an eye far away. */
  hidden(point: Vec, towards: Vec): boolean {
    return this.between(point, towards).some((owner) => this.drawn.solid(owner));
  }

  /** What lies there, be it seen through or hidden. */
  between(point: Vec, towards: Vec): Owner[] {
    const step = 1e-4 * this.stage.table.radius;
    const ray = new Ray(new Vector3(...plus(point, towards, step)), new Vector3(...towards));
    const { owner, tree } = this.drawn;
    return tree.raycast(ray, DoubleSide).flatMap(({ face }) => (face && this.drawn.there(owner[face.a]) ? [owner[face.a]] : []));
  }
}

// The whole tool assembly in place: its outline turned about its axis, each part in a grey of its own.

import { Group, LatheGeometry, Matrix4, Mesh, type ShaderMaterial, Vector2, Vector3 } from "./three";
import type { Placed } from "./contact.ts";
import type { Cutter, PartName } from "./meta.ts";
import { ghostMaterial, toolMaterial } from "./shading.ts";
import { across, cross } from "./vectors.ts";

const GREYS: Record<PartName, string> = { flutes: "#e6e9ec", neck: "#c3c9cf", shank: "#9aa2aa", holder: "#5c646d" };

export class ToolView {
  readonly group = new Group();
  private readonly materials = {} as Record<PartName, ShaderMaterial>;
  /** For what of the tool lies behind or in the part: it is never out of sight. */
  private readonly ghost = ghostMaterial();
  private of: string | null = null;
  private glass = true;

  constructor() {
    for (const part of Object.keys(GREYS) as PartName[]) this.materials[part] = toolMaterial(GREYS[part]);
    this.group.matrixAutoUpdate = false;
    this.group.visible = false;
    this.seeThrough(true);
  }

  show(cutter: Cutter, { tip, axis }: Placed): void {
    if (this.of !== cutter.id) {
      this.of = cutter.id;
      for (const child of this.group.children) (child as Mesh).geometry.dispose();
      this.group.clear();
      for (const { part, points } of cutter.outline) {
        if (points.length < 2) continue;
        const profile = points.map(([r, h]) => new Vector2(Math.max(r, 1e-6), h));
        const geometry = new LatheGeometry(split(profile), 64);
        const mesh = new Mesh(geometry, this.materials[part]);
        mesh.renderOrder = 5;
        const hidden = new Mesh(geometry, this.ghost);
        hidden.renderOrder = 4;
        this.group.add(hidden, mesh);
      }
    }
    // A lathe turns about its y.
    const x = across(axis);
    const z = cross(x, axis);
    this.group.matrix = new Matrix4()
      .makeBasis(new Vector3(...x), new Vector3(...axis), new Vector3(...z))
      .setPosition(...tip);
    this.group.matrixWorldNeedsUpdate = true;
    this.group.visible = true;
  }

  hide(): void {
    this.group.visible = false;
  }

  seeThrough(glass: boolean): void {
    this.glass = glass;
    for (const material of Object.values(this.materials)) {
      material.uniforms.opacity.value = glass ? 0.55 : 1;
      material.transparent = glass;
      material.needsUpdate = true;
    }
  }

  get transparent(): boolean {
    return this.glass;
  }
}

/** Corners of more than a few degrees twice, so that they are drawn sharp. */
function split(profile: Vector2[]): Vector2[] {
  const out: Vector2[] = [];
  profile.forEach((point, i) => {
    out.push(point);
    if (i === 0 || i + 1 === profile.length) return;
    const before = point.clone().sub(profile[i - 1]);
    const after = profile[i + 1].clone().sub(point);
    if (Math.abs(before.angleTo(after)) > 0.45) out.push(point.clone().addScaledVector(after, 1e-5));
  });
  return out;
}

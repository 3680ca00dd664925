// The outline of what is in the way: a mask of it, whole whatever lies before it, and a line along the mask's borders.

import { type BufferGeometry, Mesh, PlaneGeometry, Scene, Vector2, WebGLRenderTarget } from "./three";
import type { Drawn, Owner } from "./mesh.ts";
import { contourMaterial, maskMaterial } from "./shading.ts";
import type { Stage } from "./stage.ts";

export class Outline {
  private owner: Owner | null = null;
  private readonly of = new Scene();
  private readonly over = new Scene();
  private readonly mask = new WebGLRenderTarget(1, 1, { depthBuffer: false });
  private readonly contour = contourMaterial();
  private readonly geometries = new Map<Owner, BufferGeometry>();

  constructor(
    private readonly stage: Stage,
    private readonly drawn: Drawn,
  ) {
    this.contour.uniforms.mask.value = this.mask.texture;
    const quad = new Mesh(new PlaneGeometry(2, 2), this.contour);
    quad.frustumCulled = false;
    this.over.add(quad);
    stage.afterDraw(() => this.draw());
  }

  /** Outline a face or a fixture; null: nothing. */
  show(owner: Owner | null): void {
    if (owner === this.owner) return;
    this.owner = owner;
    this.of.clear();
    const range = owner === null ? null : this.drawn.rangeOf(owner);
    if (owner === null || !range) return;
    let geometry = this.geometries.get(owner);
    if (!geometry) this.geometries.set(owner, (geometry = this.drawn.geometry(range.start, range.count)));
    const mesh = new Mesh(geometry, this.material);
    mesh.frustumCulled = false;
    this.of.add(mesh);
  }

  private readonly material = maskMaterial();

  private draw(): void {
    if (this.owner === null || !this.of.children.length) return;
    const { renderer, table } = this.stage;
    const size = renderer.getDrawingBufferSize(new Vector2());
    this.mask.setSize(size.x, size.y);
    renderer.setRenderTarget(this.mask);
    renderer.render(this.of, table.camera);
    renderer.setRenderTarget(null);
    renderer.autoClear = false;
    renderer.render(this.over, table.camera);
    renderer.autoClear = true;
  }
}

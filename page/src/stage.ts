// The canvas: it is drawn when something has changed, and at no other time.

import { BufferGeometry, type Material, Mesh, type Object3D, Scene, Vector3, WebGLRenderer } from "./three";
import { Turntable } from "./camera.ts";
import type { Meta, Vec } from "./meta.ts";
import { shared } from "./shading.ts";
import { distance, mixed, unit } from "./vectors.ts";

/** Length of the longest tool, mm. */
const longest = ({ cutters }: Meta): number =>
  Math.max(0, ...cutters.flatMap(({ outline }) => outline.flatMap(({ points }) => points.map(([r, h]) => r + h))));

export class Stage {
  readonly scene = new Scene();
  readonly table: Turntable;
  readonly renderer: WebGLRenderer;
  private asked = 0;
  private readonly before: (() => void)[] = [];
  private readonly after: (() => void)[] = [];
  private begun = false;

  /** Throws where there is no WebGL. */
  constructor(readonly canvas: HTMLCanvasElement, meta: Meta, vertices: () => Float32Array) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, stencil: true, powerPreference: "default" });
    // To ask whether a program was linked is to wait for it.
    this.renderer.debug.checkShaderErrors = false;
    this.renderer.setClearAlpha(0);
    this.renderer.autoClear = true;
    const { low, high } = meta.part;
    this.table = new Turntable(
      unit(meta.setup.z),
      meta.setup.x,
      mixed(low, 0.5, high, 0.5),
      Math.max(1e-6, distance(low, high) / 2),
      () => this.request(),
      vertices,
      longest(meta),
    );
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    canvas.addEventListener("webglcontextrestored", () => this.request());
  }

  add(...objects: Object3D[]): void {
    for (const object of objects) this.scene.add(object);
  }

  /** Called before each drawing. */
  beforeDraw(work: () => void): void {
    this.before.push(work);
  }

  /** Called after each drawing, to draw over it. */
  afterDraw(work: () => void): void {
    this.after.push(work);
  }

  /** Let the browser compile a material while the data are still read. */
  warm(material: Material): void {
    this.renderer.compile(new Mesh(new BufferGeometry(), material), this.table.camera);
  }

  /** Draw from now on: all that is to be seen is there. `first`: choose the first view, of which nothing is drawn before. */
  begin(first: () => void): void {
    const box = this.canvas.parentElement!.getBoundingClientRect();
    this.table.resize(Math.max(1, box.width) / Math.max(1, box.height));
    first();
    this.begun = true;
    this.resize();
  }

  request(): void {
    if (this.begun) this.asked ||= requestAnimationFrame(() => this.draw());
  }

  /** `over`: with what is drawn over the picture. */
  draw(over = true): void {
    cancelAnimationFrame(this.asked);
    this.asked = 0;
    for (const work of this.before) work();
    this.renderer.render(this.scene, this.table.camera);
    if (over) for (const work of this.after) work();
  }

  /** The picture as it is, as a PNG in words. */
  still(): string {
    this.draw();
    return this.canvas.toDataURL("image/png");
  }

  /** Take the room of the frame now, not only at the next frame: views are chosen for it. */
  refit(): void {
    const { clientWidth, clientHeight, parentElement } = this.canvas;
    const box = parentElement!.getBoundingClientRect();
    if (Math.floor(box.width) !== clientWidth || Math.floor(box.height) !== clientHeight) this.resize();
  }

  resize(): void {
    if (!this.begun) return;
    const box = this.canvas.parentElement!.getBoundingClientRect();
    const [width, height] = [Math.max(1, Math.floor(box.width)), Math.max(1, Math.floor(box.height))];
    const ratio = Math.min(2, devicePixelRatio || 1);
    shared.ratio.value = ratio;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height);
    this.table.resize(width / height);
    // A canvas that was resized is empty until it is drawn: not left so for a frame.
    this.draw();
  }

  /** Where a point is in the picture, pixels from the canvas's corner. */
  project(point: Vec): [number, number] {
    const place = new Vector3(...point).project(this.table.camera);
    return [((place.x + 1) / 2) * this.canvas.clientWidth, ((1 - place.y) / 2) * this.canvas.clientHeight];
  }

  /** A place in the picture as -1 to 1 each way. */
  place(event: { clientX: number; clientY: number }): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    return [(2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height];
  }
}

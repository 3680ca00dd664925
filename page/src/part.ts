// The part and its fixtures in 3D, coloured sample by sample through the atlas; borders of faces; the outline of what is in the way.

import {
  BufferAttribute, BufferGeometry, type DataTexture, DoubleSide, Group, LineSegments, Mesh, PlaneGeometry, Scene, type ShaderMaterial, Vector2,
  WebGLRenderTarget,
} from "./three";
import { colourOf, type Look, rgb } from "./colours.ts";
import type { Arrays } from "./decode.ts";
import type { Drawn, Owner } from "./mesh.ts";
import { atlasTexture, contourMaterial, maskMaterial, NOBODY, plainMaterial } from "./shading.ts";
import type { Stage } from "./stage.ts";

/** Added to the pattern of a sample that is faded, so that others stand out. */
const FADED = 64;
/** A texel of no sample. */
const NO_SAMPLE = 255;

export class PartView {
  readonly group = new Group();
  private readonly texture: DataTexture;
  private readonly index: ArrayLike<number>;
  private readonly width: number;
  private readonly height: number;

  private readonly faces: Mesh | null = null;
  private readonly fixtures: [Owner, Mesh][] = [];
  /** Of a fixture that is seen through. */
  private readonly faded: ShaderMaterial;

  constructor(private readonly drawn: Drawn, arrays: Pick<Arrays, "get">, readonly material: ShaderMaterial) {
    [this.width, this.height] = drawn.meta.atlas ?? [1, 1];
    this.index = drawn.meta.atlas ? arrays.get("atlas.index").values : [-1];
    this.texture = atlasTexture(this.width, this.height);
    this.material.uniforms.colours.value = this.texture;
    const tint = rgb(colourOf(drawn.meta, "fixture")).map((x) => (x / 255).toFixed(3));
    this.faded = plainMaterial(`${tint.join(", ")}, 0.13`, { transparent: true, depthWrite: false, side: DoubleSide });
    if (drawn.ofFaces) this.group.add((this.faces = new Mesh(drawn.geometry(0, drawn.ofFaces), [this.material])));
    drawn.meta.fixtures.forEach(({ start, count }, i) => {
      const mesh = new Mesh(drawn.geometry(start, count), this.material);
      this.fixtures.push([-1 - i, mesh]);
      if (count) this.group.add(mesh);
    });
    this.stand();
  }

  /** Show the fixtures of the setup that is shown, and no others; nothing that is hidden. */
  stand(): void {
    const { drawn } = this;
    for (const [owner, mesh] of this.fixtures) {
      mesh.visible = drawn.seen(owner);
      mesh.material = drawn.fading.has(owner) ? this.faded : this.material;
      // After all that is solid.
      mesh.renderOrder = drawn.fading.has(owner) ? 3 : 0;
    }
    if (!this.faces) return;
    const runs = drawn.meta.faces.map(({ start, count }, i): [Owner, number, number] => [i, 3 * start, 3 * count]);
    showRuns(this.faces.geometry, runs.sort((a, b) => a[1] - b[1]), (owner) => drawn.seen(owner));
  }

  /** Colour every sample; where some are to stand out, fade the others. */
  paint(look: Look, lit: ((row: number) => boolean) | null = null): void {
    const data = this.texture.image.data as Uint8Array;
    const words = new Uint32Array(data.buffer);
    const colours = new Uint32Array(look.bytes.buffer, look.bytes.byteOffset, look.bytes.length / 4);
    const word = (alpha: number): number => new Uint32Array(new Uint8Array([0, 0, 0, alpha]).buffer)[0];
    const [none, faded] = [word(NO_SAMPLE), word(FADED)];
    for (let i = 0; i < words.length; i++) {
      const row = this.index[i];
      words[i] = row < 0 ? none : lit && !lit(row) ? colours[row] | faded : colours[row];
    }
    this.texture.needsUpdate = true;
  }

  /** The sample at a place in the atlas; null where there is none. */
  sampleAt(x: number, y: number): number | null {
    if (x < -0.5) return null;
    const column = Math.min(this.width - 1, Math.max(0, Math.round(x)));
    const line = Math.min(this.height - 1, Math.max(0, Math.round(y)));
    const row = this.index[line * this.width + column];
    return row >= 0 ? row : null;
  }

  /** The samples next to a sample on its grid: left, right, down, up; null where there is none. */
  neighbours(row: number): (number | null)[] {
    const at = this.places().get(row);
    if (at === undefined) return [null, null, null, null];
    const [x, y] = [at % this.width, Math.floor(at / this.width)];
    const near = ([dx, dy]: number[]): number | null => {
      // Some texels repeat the nearest sample: go on until another one comes.
      for (let step = 1; step < 4; step++) {
        const [u, v] = [x + step * dx, y + step * dy];
        if (u < 0 || v < 0 || u >= this.width || v >= this.height) return null;
        const found = this.index[v * this.width + u];
        if (found < 0) return null;
        if (found !== row) return found;
      }
      return null;
    };
    return [[-1, 0], [1, 0], [0, -1], [0, 1]].map(near);
  }

  private place: Map<number, number> | null = null;

  private places(): Map<number, number> {
    if (!this.place) {
      this.place = new Map();
      for (let i = 0; i < this.index.length; i++) {
        if (this.index[i] >= 0 && !this.place.has(this.index[i])) this.place.set(this.index[i], i);
      }
    }
    return this.place;
  }

  light(hot: Owner | null, held: Owner | null): void {
    this.material.uniforms.hot.value = hot ?? NOBODY;
    this.material.uniforms.held.value = held ?? NOBODY;
  }
}

/** The borders of faces as thin lines, with which a part reads better; those of what is hidden are not drawn. */
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

/** The outline of what is in the way: a mask of it, whole whatever lies before it, and a line along the borders of the mask. */
export class Outline {
  private owner: Owner | null = null;
  private readonly of = new Scene();
  private readonly over = new Scene();
  private readonly mask = new WebGLRenderTarget(1, 1, { depthBuffer: false });
  private readonly contour = contourMaterial();
  private readonly geometries = new Map<Owner, BufferGeometry>();

  constructor(private readonly stage: Stage, private readonly drawn: Drawn) {
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

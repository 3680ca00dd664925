// The part and its fixtures in 3D, coloured sample by sample through the atlas.

import { type DataTexture, DoubleSide, Group, Mesh, type ShaderMaterial } from "./three";
import { colourOf, type Look, rgb } from "./colours.ts";
import type { Arrays } from "./decode.ts";
import type { Drawn, Owner } from "./mesh.ts";
import { showRuns } from "./edges.ts";
import { atlasTexture, NOBODY, plainMaterial } from "./shading.ts";

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

  constructor(
    private readonly drawn: Drawn,
    arrays: Pick<Arrays, "get">,
    readonly material: ShaderMaterial,
  ) {
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

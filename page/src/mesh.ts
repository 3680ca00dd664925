// The drawn triangles: those of the faces in order, then those of the fixtures; and the tree over them.

import { BufferAttribute, BufferGeometry, MeshBVH } from "./three";
import type { Arrays, Table } from "./decode.ts";
import type { Meta, Vec } from "./meta.ts";
import { octahedral } from "./vectors.ts";

/** Owner of a triangle: a face by its place in `meta.faces`, or a fixture: -1 for the first one, -2, ... */
export type Owner = number;
/** No place in the atlas: the surface there has no samples. */
export const NO_TEXEL = 65535;

/** The columns of a table beside each other, each value as it is meant. */
function beside<T extends Float32Array | Uint32Array>({ rows, values }: Table, columns: number, meant: (value: number, column: number) => number, into: T): T {
  for (let k = 0; k < columns; k++) for (let i = 0; i < rows; i++) into[columns * i + k] = meant(values[k * rows + i], k);
  return into;
}

export class Drawn {
  readonly position: Float32Array;
  readonly normal: Int8Array;
  readonly texel: Float32Array;
  readonly owner: Float32Array;
  /** Of each vertex the least and the largest column and row (x, y, x, y) of the atlas that its face has. */
  readonly sheet: Uint16Array;
  readonly triangle: Uint32Array;
  /** Of each vertex a number of its place: equal ones lie at one place. */
  readonly cell: Float64Array;
  /** Triangles of faces; those of fixtures follow. */
  readonly ofFaces: number;
  /** The setup whose fixtures are there, counted from 0; those of others are neither seen nor met. */
  setup = 0;
  private made: MeshBVH | null = null;

  constructor(readonly meta: Meta, arrays: Arrays) {
    const { low, high } = meta.part;
    const place = arrays.get("mesh.position");
    const count = place.rows;
    const step = [0, 1, 2].map((k) => (high[k] - low[k]) / 65535);
    this.position = beside(place, 3, (value, k) => low[k] + step[k] * value, new Float32Array(3 * count));
    this.cell = new Float64Array(count);
    for (let i = 0; i < count; i++) {
      this.cell[i] = place.values[i] + 65536 * (place.values[count + i] + 65536 * place.values[2 * count + i]);
    }
    const bent = arrays.get("mesh.normal");
    this.normal = new Int8Array(4 * count);
    for (let i = 0; i < count; i++) {
      const n = octahedral((bent.values[i] - 127) / 127, (bent.values[count + i] - 127) / 127);
      for (let k = 0; k < 3; k++) this.normal[4 * i + k] = Math.round(127 * n[k]);
    }
    const texel = arrays.get("mesh.texel");
    this.texel = beside(texel, 2, (value) => value / 16, new Float32Array(2 * count));
    for (let i = 0; i < count; i++) if (texel.values[i] === NO_TEXEL) this.texel.fill(-1, 2 * i, 2 * i + 2);
    const corner = arrays.get("mesh.triangle");
    this.triangle = beside(corner, 3, (value) => value, new Uint32Array(3 * corner.rows));
    this.owner = new Float32Array(count);
    this.ofFaces = meta.faces.reduce((most, face) => Math.max(most, face.start + face.count), 0);
    this.sheet = new Uint16Array(4 * count);
    meta.faces.forEach((face, i) => {
      this.own(face, i);
      this.lay(face);
    });
    meta.fixtures.forEach((fixture, i) => this.own(fixture, -1 - i));
  }

  /** Whether an owner is there in the setup shown. */
  there(owner: Owner): boolean {
    return owner >= 0 || this.meta.fixtures[-1 - owner].setups.includes(this.setup);
  }

  /** What the reviewer hides, and what is faded so that what lies behind is seen; both still stand in the way of tools. */
  readonly hiding = new Set<Owner>();
  readonly fading = new Set<Owner>();

  /** Whether an owner is in the picture, if only faded. */
  seen(owner: Owner): boolean {
    return this.there(owner) && !this.hiding.has(owner);
  }

  /** Whether an owner hides what lies behind it. */
  solid(owner: Owner): boolean {
    return this.seen(owner) && !this.fading.has(owner);
  }

  /** Vertices of the part, three numbers each: what a picture is to show, whatever holds it. */
  get shownVertices(): Float32Array {
    if (!this.shown) {
      let end = 0;
      for (let i = 0; i < 3 * this.ofFaces; i++) end = Math.max(end, this.triangle[i] + 1);
      this.shown = this.position.subarray(0, 3 * end);
    }
    return this.shown;
  }

  /** Corners of the part's own triangles. */
  *partPoints(): Generator<Vec> {
    const { position } = this;
    for (let i = 0; i < position.length && this.owner[i / 3] >= 0; i += 3) yield [position[i], position[i + 1], position[i + 2]];
  }

  private shown: Float32Array | null = null;

  /** Half the diagonal of the part's box, mm. */
  get partRadius(): number {
    const [x, y, z] = this.meta.part.size_mm;
    return Math.max(1e-6, Math.hypot(x, y, z) / 2);
  }

  private own(range: { start: number; count: number }, owner: Owner): void {
    const end = 3 * (range.start + range.count);
    for (let i = 3 * range.start; i < end; i++) this.owner[this.triangle[i]] = owner;
  }

  /** Say of the vertices of a face which part of the atlas is its own: its grid, or one texel for each triangle without a grid. */
  private lay({ start, count }: { start: number; count: number }): void {
    const { texel, triangle, sheet } = this;
    const corners = triangle.subarray(3 * start, 3 * (start + count));
    const ends = [Infinity, Infinity, -Infinity, -Infinity];
    let single = true;
    for (let i = 0; i < corners.length; i++) {
      const [x, y] = [texel[2 * corners[i]], texel[2 * corners[i] + 1]];
      if (x < 0) return;
      const first = corners[i - (i % 3)];
      single &&= x === texel[2 * first] && y === texel[2 * first + 1];
      ends[0] = Math.min(ends[0], x);
      ends[1] = Math.min(ends[1], y);
      ends[2] = Math.max(ends[2], x);
      ends[3] = Math.max(ends[3], y);
    }
    for (const i of corners) {
      for (let k = 0; k < 4; k++) {
        sheet[4 * i + k] = single ? Math.round(texel[2 * i + (k % 2)]) : k < 2 ? Math.floor(ends[k]) : Math.ceil(ends[k]);
      }
    }
  }

  /** Triangles from the first one on, as geometry that shares the vertices. */
  geometry(first: number, count: number): BufferGeometry {
    const geometry = new BufferGeometry();
    const sizes = { position: 3, normal: 4, texel: 2, sheet: 4, owner: 1 } as const;
    for (const name of Object.keys(sizes) as (keyof typeof sizes)[]) geometry.setAttribute(name, this.shared(name, this[name], sizes[name]));
    geometry.setIndex(new BufferAttribute(this.triangle.subarray(3 * first, 3 * (first + count)), 1));
    return geometry;
  }

  private readonly attributes = new Map<string, BufferAttribute>();

  private shared(name: string, values: Float32Array | Uint16Array | Int8Array, size: number): BufferAttribute {
    const attribute = this.attributes.get(name) ?? new BufferAttribute(values, size, values instanceof Int8Array);
    this.attributes.set(name, attribute);
    return attribute;
  }

  /** The tree over all triangles; it orders its own copy of them. */
  get tree(): MeshBVH {
    if (!this.made) {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(this.position, 3));
      geometry.setIndex(new BufferAttribute(this.triangle.slice(), 1));
      this.made = new MeshBVH(geometry, { targetLeafSize: 8 });
    }
    return this.made;
  }

  /** What a triangle belongs to, as planners know it: a face's id, or a fixture's name. */
  called(owner: Owner): string {
    if (owner >= 0) return this.meta.faces[owner]?.id ?? "";
    return `fixture ${this.meta.fixtures[-1 - owner]?.name.replace(/^fixture:/, "") ?? ""}`;
  }

  /** The owner that a plan names as `F12` or `fixture:NAME`. */
  ownerOf(name: string | null): Owner | null {
    if (!name) return null;
    const face = this.meta.faces.findIndex((each) => each.id === name);
    if (face >= 0) return face;
    const mine = this.meta.fixtures.map((each) => name === `fixture:${each.name}` || name === each.name);
    // Fixtures of several setups may have one name.
    const fixture = mine.findIndex((same, i) => same && this.there(-1 - i));
    return fixture >= 0 ? -1 - fixture : mine.includes(true) ? -1 - mine.indexOf(true) : null;
  }

  /** The triangles of an owner; null where none are drawn. */
  rangeOf(owner: Owner): { start: number; count: number } | null {
    const range = owner >= 0 ? this.meta.faces[owner] : this.meta.fixtures[-1 - owner];
    return range?.count ? range : null;
  }

  /** The middle of what an owner covers, by its box. */
  middle(owner: Owner): { centre: Vec; radius: number } | null {
    const range = this.rangeOf(owner);
    if (!range) return null;
    const low: Vec = [Infinity, Infinity, Infinity];
    const high: Vec = [-Infinity, -Infinity, -Infinity];
    for (let i = 3 * range.start; i < 3 * (range.start + range.count); i++) {
      for (let k = 0; k < 3; k++) {
        const x = this.position[3 * this.triangle[i] + k];
        low[k] = Math.min(low[k], x);
        high[k] = Math.max(high[k], x);
      }
    }
    return {
      centre: low.map((x, k) => (x + high[k]) / 2) as Vec,
      radius: Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2,
    };
  }
}

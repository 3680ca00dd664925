// Two plans: the form of their data, as plan_cutters_ci.review writes it; what their parts are coloured by; and the picture of one.

import type { ShaderMaterial } from "./three";
import type { Aim, View } from "./camera.ts";
import { colourOf, type Entry, type Look, lookOf, painted, PATTERNS, patternOf, rgb, spoken } from "./colours.ts";
import { type Arrays, text } from "./decode.ts";
import { el } from "./dom.ts";
import { Drawn, type Owner } from "./mesh.ts";
import type { Meta, Pattern, Vec } from "./meta.ts";
import { Borders, PartView } from "./part.ts";
import { Picker } from "./pick.ts";
import { Samples } from "./samples.ts";
import { partMaterial } from "./shading.ts";
import { Stage } from "./stage.ts";
import { cross, dot, minus, plus, scaled, unit } from "./vectors.ts";

export const WORDS = ["old", "new"] as const;
export type Word = (typeof WORDS)[number];

export interface Mark {
  label: string;
  colour: string;
  pattern: Pattern;
}

export interface Pair {
  name: string;
  /** Ids; null: it is not among the cutters of that plan. */
  old: string | null;
  new: string | null;
}

export interface Told {
  /** What can become of a face, in the order of the legend. */
  marks: Record<string, Mark>;
  /** What became of each face: a word of `marks` by its id. */
  states: Record<Word, Record<string, string>>;
  /** Ids of the faces that were known again, old and new. */
  pairs: [string, string][];
  cutters: Pair[];
  /** Null: there is no picture of that plan. */
  old: Meta | null;
  new: Meta | null;
}

export function readTold(): Told {
  const told = JSON.parse(text("meta")) as Told;
  for (const word of WORDS) {
    const format = told[word]?.format ?? 1;
    if (format !== 1) throw new Error(`the data have format ${format}, this page reads 1`);
  }
  return told;
}

/** From worst to best: a sample is shown as the best cutter reaches it. */
const RANK = ["unjudged", "inaccessible", "undecided", "accessible", "interference_free"];
const ABSENT: Entry = { colour: "#9a9a9a", pattern: "back", label: "not among the cutters of this plan" };

/** A colour for each face, by its place in `meta.faces`. */
export function facesLook(told: Told, { word, meta }: Side): Look {
  const words = Object.keys(told.marks);
  const state = meta.faces.map(({ id }) => words.indexOf(told.states[word][id] ?? "not asked"));
  const bytes = new Uint8Array(4 * meta.faces.length);
  const marks = Object.values(told.marks);
  const table = marks.map((each) => [...rgb(each.colour), PATTERNS.indexOf(each.pattern)]);
  state.forEach((k, i) => bytes.set(table[k], 4 * i));
  const count = marks.map((_, k) => state.filter((each) => each === k).length);
  return { title: "Faces", entries: marks.map((each, k) => ({ ...each, share: count[k] })).filter((each) => each.share), ramp: null, bytes };
}

/** A colour for each sample: verdicts of a cutter, or the best ones of all where `pair` is null. */
export function verdictLook(told: Told, side: Side, number: number | null): Look {
  const { word, meta, arrays, samples } = side;
  if (number !== null) {
    const id = told.cutters[number]?.[word] ?? null;
    return id === null ? painted(meta, "", [ABSENT], samples, () => 0) : lookOf(meta, arrays, samples, "verdict", id);
  }
  const entries = [...RANK, "inside_bodies", "drilled"].map((each) => ({
    colour: colourOf(meta, each),
    pattern: patternOf(each),
    label: spoken(meta, each),
  }));
  const best = new Uint8Array(samples.count);
  for (const { id } of meta.cutters) {
    const { values } = samples.verdicts(id);
    const rank = Array.from({ length: 256 }, (_, code) => Math.max(0, RANK.indexOf(meta.verdicts[String(code)] ?? "")));
    for (let i = 0; i < best.length; i++) best[i] = Math.max(best[i], rank[values[i]]);
  }
  const drilled = (i: number): boolean => samples.verdict(meta.cutters[0].id, i) === "drilled";
  return painted(meta, "", entries, samples, (i) => (samples.inside(i) ? RANK.length : drilled(i) ? RANK.length + 1 : best[i]));
}

/** Texels in a line of the atlas of faces: every device has that many. */
const LINE = 1024;

/** The triangles with a place in an atlas that has one texel for each face: faces without samples have a colour, too. */
class DrawnFaces extends Drawn {
  constructor(meta: Meta, arrays: Arrays) {
    super({ ...meta, atlas: [LINE, Math.max(1, Math.ceil(meta.faces.length / LINE))] }, arrays);
    this.owner.forEach((owner, i) => {
      const [x, y] = owner < 0 ? [-1, -1] : [owner % LINE, Math.floor(owner / LINE)];
      this.texel.set([x, y], 2 * i);
      // Each face is a sheet of its own: no other one has a say in its colour.
      if (owner >= 0) this.sheet.set([x, y, x, y], 4 * i);
    });
  }
}

export class Side {
  readonly frame = el("div", { class: "frame" });
  readonly under = el("p", { class: "under" });
  readonly drawn: Drawn;
  private readonly faces: PartView;
  private readonly places: Map<string, Owner>;
  private madeSamples: Samples | null = null;
  private madeVerdicts: PartView | null = null;
  private stage_: Stage | null = null;
  private picker: Picker | null = null;

  constructor(readonly word: Word, readonly meta: Meta, readonly arrays: Arrays) {
    this.drawn = new DrawnFaces(meta, arrays);
    const index = Int32Array.from({ length: LINE * this.drawn.meta.atlas![1] }, (_, i) => (i < meta.faces.length ? i : -1));
    this.faces = new PartView(this.drawn, { get: () => ({ rows: index.length, columns: 1, values: index }) }, this.material());
    this.places = new Map(meta.faces.map(({ id }, i) => [id, i]));
  }

  /** Made when it is asked for, as is what is coloured by samples: the first view is one of faces. */
  get samples(): Samples {
    this.madeSamples ??= new Samples(this.meta, this.arrays);
    return this.madeSamples;
  }

  private get verdicts(): PartView {
    if (!this.madeVerdicts) {
      this.madeVerdicts = new PartView(new Drawn(this.meta, this.arrays), this.arrays, this.material());
      this.stage.add(this.madeVerdicts.group);
    }
    return this.madeVerdicts;
  }

  private material(): ShaderMaterial {
    return partMaterial(colourOf(this.meta, "check"), colourOf(this.meta, "fixture"));
  }

  /** Put the picture into its pane; throws where there is no WebGL. */
  show(pane: Element, view: Meta, vertices: () => Float32Array): void {
    const canvas = el("canvas", {
      tabindex: 0,
      role: "application",
      "aria-label": `The ${this.word} part in 3D. Arrow keys turn both parts, n and p step through the changes.`,
    });
    this.frame.append(canvas, this.under);
    pane.append(this.frame);
    this.stage_ = new Stage(canvas, view, vertices);
    this.stage_.add(this.faces.group);
    this.picker = new Picker(this.stage_, this.drawn, this.faces);
  }

  get stage(): Stage {
    if (!this.stage_) throw new Error("there is no picture");
    return this.stage_;
  }

  outline(): void {
    this.stage.add(new Borders(this.drawn).lines);
    this.stage.request();
  }

  /** Colour it, by faces or by samples. */
  paint(look: Look, byFace: boolean): void {
    (byFace ? this.faces : this.verdicts).paint(look);
    this.faces.group.visible = byFace;
    if (this.madeVerdicts) this.madeVerdicts.group.visible = !byFace;
    this.stage.request();
  }

  /** Light a face up; null: none. */
  light(id: string | null): void {
    const owner = id === null ? null : (this.places.get(id) ?? null);
    for (const part of [this.faces, this.madeVerdicts]) part?.light(owner, null);
    this.stage.request();
  }

  /** The face at a place of the picture. */
  faceAt(x: number, y: number): string | null {
    const found = this.picker?.at(x, y);
    return found && found.owner >= 0 ? (this.meta.faces[found.owner]?.id ?? null) : null;
  }

  /** A place in the middle of a face and the normal there; null where it is not drawn. */
  private middle(id: string): { point: Vec; normal: Vec } | null {
    const { start, count } = this.meta.faces[this.places.get(id) ?? -1] ?? { start: 0, count: 0 };
    if (!count) return null;
    const { triangle, position } = this.drawn;
    const [a, b, c] = [0, 1, 2].map((k): Vec => {
      const i = 3 * triangle[3 * (start + (count >> 1)) + k];
      return [position[i], position[i + 1], position[i + 2]];
    });
    return { point: scaled(plus(plus(a, b), c), 1 / 3), normal: unit(cross(minus(b, a), minus(c, a))) };
  }

  /** Whether the middle of a face is seen from where one looks now. */
  sees(id: string): boolean {
    const found = this.middle(id);
    const { back } = this.stage.table.frame();
    return found !== null && dot(back, found.normal) > 0.1 && !this.picker?.hidden(found.point, back);
  }

  /** Where to look from to see a face; null where it is not drawn. */
  aimAt(id: string): Aim | null {
    const found = this.middle(id);
    const place = found && this.drawn.middle(this.places.get(id)!);
    if (!found || !place) return null;
    const half = Math.max(1.4 * place.radius, 0.25 * this.drawn.partRadius);
    return { target: place.centre, half, ...this.open(found.point, found.normal, this.stage.table.towards(found.normal)) };
  }

  /** A view from which nothing hides a point of the surface, as near as can be to one. */
  private open(point: Vec, normal: Vec, ideal: View): View {
    const { table } = this.stage;
    const back = (view: View): Vec => table.frame({ ...table.aim, ...view }).back;
    const every = [ideal];
    for (let turn = 0; turn < 360; turn += 20) for (let rise = -70; rise <= 80; rise += 15) every.push({ turn, rise });
    const near = every.filter((view) => dot(back(view), normal) > 0);
    near.sort((one, other) => dot(back(other), back(ideal)) - dot(back(one), back(ideal)));
    return near.find((view) => !this.picker?.hidden(point, back(view))) ?? ideal;
  }
}

// What is shown now: cutter, colouring, sample, posture, what is lit up. Views read it and are called when it has changed; it knows none.

import { type Look, lookOf } from "./colours.ts";
import { place, type Placed } from "./contact.ts";
import type { Arrays } from "./decode.ts";
import { LiveTool, type Met, Probe } from "./live_map.ts";
import { Machine } from "./machine.ts";
import { Drawn, type Owner } from "./mesh.ts";
import type { Cutter, Meta, Operation, OperationPlan, Spot, Step, Vec } from "./meta.ts";
import { firstMode, planOf, postureOf, PROCESS, stepOf, takenBy } from "./plans.ts";
import { type Judged, SampleMap } from "./sample_map.ts";
import { alike, type Posture, type Sample, Samples } from "./samples.ts";
import { cross, norm, turned } from "./vectors.ts";

/** Sine of an angle between tool axes that are nearly one. */
const NEAR = 1e-3;

/** What can change; `there` is what of the part and around it is in the picture. */
type Change = "cutter" | "look" | "lift" | "sample" | "posture" | "hot" | "there" | "said";

export class PageState {
  readonly samples: Samples;
  readonly drawn: Drawn;
  /** Stands in the setup that serves the sample shown. */
  readonly machine: Machine;
  cutter: Cutter;
  mode: string;
  /** Samples that stand out, whatever is shown; null: none. */
  lifted: ((row: number) => boolean) | null = null;
  sample: Sample | null = null;
  /** The postures of the sample shown. */
  map: SampleMap | null = null;
  spot: Spot | null = null;
  posture: Posture | null = null;
  /** What stands in the way at the posture, and what is to be said of it. */
  met: Met | null = null;
  judged: Judged | null = null;
  /** The face under the pointer; from a list, it is lit up in the picture. */
  hot: Owner | null = null;
  lit = false;
  toolShown = true;
  /** What was said last. */
  said = "";
  private madeLook: Look | null = null;
  private madeProbe: Probe | null = null;
  private readonly liveTools = new Map<string, LiveTool>();
  private readonly listeners = new Map<Change, (() => void)[]>();

  constructor(readonly meta: Meta, readonly arrays: Arrays) {
    this.samples = new Samples(meta, arrays);
    this.drawn = new Drawn(meta, arrays);
    this.machine = new Machine(meta);
    this.cutter = this.cutterOf(meta.shown);
    this.mode = firstMode(meta);
  }

  on(change: Change, work: () => void): void {
    this.listeners.set(change, [...(this.listeners.get(change) ?? []), work]);
  }

  private emit(change: Change): void {
    for (const work of this.listeners.get(change) ?? []) work();
  }

  /** Say something in the status line, which is read out. */
  readonly say = (text: string): void => {
    this.said = text;
    this.emit("said");
  };

  cutterOf(id: string): Cutter {
    return this.meta.cutters.find((each) => each.id === id) ?? this.meta.cutters[0];
  }

  get probe(): Probe {
    return (this.madeProbe ??= new Probe(this.drawn, this.meta, this.machine));
  }

  liveTool(cutter = this.cutter): LiveTool {
    const tool = this.liveTools.get(cutter.id) ?? new LiveTool(cutter, this.meta);
    this.liveTools.set(cutter.id, tool);
    return tool;
  }

  setCutter(id: string): void {
    this.cutter = this.cutterOf(id);
    this.spot = null;
    this.emit("cutter");
    this.repaint();
    if (this.sample) this.select(this.sample.row);
    this.say(`Cutter ${this.cutter.name || this.cutter.id} is shown`);
  }

  setMode(mode: string): void {
    const before = this.plan;
    this.mode = mode;
    this.repaint();
    // The tool at the sample is that of the operation where operations are shown.
    if (this.sample && this.plan !== before) this.select(this.sample.row, this.spot);
  }

  /** What the surface is coloured by. */
  get look(): Look {
    return (this.madeLook ??= lookOf(this.meta, this.arrays, this.samples, this.mode, this.cutter.id));
  }

  repaint(): void {
    this.madeLook = null;
    this.emit("look");
  }

  /** Let some samples stand out; null: none. */
  lift(mine: ((row: number) => boolean) | null): void {
    this.lifted = mine;
    this.emit("lift");
  }

  /** The plan of operations that is shown; null where something else is. */
  get plan(): OperationPlan | null {
    return planOf(this.meta, this.mode);
  }

  /** The operation of the plan shown that takes a sample. */
  operationAt(row: number): Operation | null {
    const { plan } = this;
    return plan?.operations[takenBy(plan, this.arrays)(row)] ?? null;
  }

  /** That of the sample shown, if it is done with the cutter shown. */
  get operation(): Operation | null {
    const found = this.sample && this.operationAt(this.sample.row);
    return found?.cutter === this.cutter.id ? found : null;
  }

  /** The step of the process that finishes a sample, where the process is shown. */
  stepAt(row: number): Step | null {
    const { process } = this.meta;
    return this.mode === PROCESS && process ? (process.steps[stepOf(this.arrays)(row) - 1] ?? null) : null;
  }

  /** Tip and axis of the tool at the posture shown. */
  placed(): Placed | null {
    return this.sample && this.posture && place(this.cutter, this.sample, this.posture);
  }

  /** Show a sample with the posture found there, or with its witness. */
  select(row: number | null, spot: Spot | null = null): void {
    const { id } = this.cutter;
    this.sample = row === null ? null : this.samples.at(row);
    this.spot = row === null ? null : (spot ?? this.meta.spots.find((each) => each.sample === row && each.cutter === id) ?? null);
    this.posture = this.met = null;
    const step = row === null ? null : this.stepAt(row);
    const planned = this.operation ?? (step?.cutter === id ? step : null);
    this.stand(planned?.setup ?? (row === null ? 0 : (this.samples.setup(id, row) ?? 0)));
    this.map = this.sample && new SampleMap(this.sample, this.meta, this.samples, this.liveTool(), this.probe);
    this.emit("sample");
    this.setPosture(row === null ? null : this.startPosture(row));
  }

  /** Let the part stand in a setup, among the fixtures there. */
  stand(setup: number): void {
    this.machine.stand(setup);
    if (this.drawn.setup === setup) return;
    this.drawn.setup = setup;
    this.emit("there");
  }

  /** Hide some owners and fade others: all of them still stand in the way of tools. */
  veil(hidden: readonly Owner[], faded: readonly Owner[]): void {
    const { hiding, fading } = this.drawn;
    hiding.clear();
    fading.clear();
    for (const owner of hidden) hiding.add(owner);
    for (const owner of faded) fading.add(owner);
    this.emit("there");
  }

  /** The posture with the axis of the operation that takes the sample shown. */
  plannedPosture(): Posture | null {
    const { operation, sample } = this;
    const axis = operation?.axis;
    if (!axis || !this.plan || !sample) return null;
    // A tool that slid along its flank touches beside the sample, as the posture found with this axis does.
    const found = operation.cutter === this.cutter.id ? this.samples.posture(this.cutter.id, sample.row) : null;
    const here = (this.samples.setup(this.cutter.id, sample.row) ?? 0) === operation.setup;
    if (found?.shift && here && norm(cross(place(this.cutter, sample, found).axis, axis)) < NEAR) return found;
    return postureOf(this.plan, this.arrays, axis, sample);
  }

  /** Tip and axis of a cutter as it stands in the plan at a sample; null where none is known. */
  standing(cutter: Cutter, row: number): Placed | null {
    const sample = this.samples.at(row);
    const axis = this.operationAt(row)?.axis;
    const posture = axis && this.plan ? postureOf(this.plan, this.arrays, axis, sample) : this.samples.posture(cutter.id, row);
    return posture && place(cutter, sample, posture);
  }

  /** The posture of the operation shown, the one found, or the witness's. */
  startPosture(row: number): Posture | null {
    return this.plannedPosture() ?? this.samples.posture(this.cutter.id, row) ?? this.witness();
  }

  private witness(): Posture | null {
    const { tilt_deg: tilt = null, lean_deg: lean = null } = this.spot ?? {};
    return tilt === null || lean === null ? null : { tilt, rotation: turned(lean) };
  }

  setPosture(posture: Posture | null): void {
    this.posture = posture;
    this.met = this.judged = null;
    if (this.map && posture) {
      this.met = this.probe.look(this.liveTool(), this.map.sample, posture, true);
      this.judged = this.map.at(posture, this.met, this.plannedPosture());
      // What is certified to be free stays so, whatever the coarse triangles say.
      if (this.judged.state === "free") this.met = null;
    }
    this.emit("posture");
  }

  /** The place and the name of what is in the way: of the witness at its posture, else of the drawn triangles. */
  inTheWay(): { point: Vec | null; owner: Owner | null } | null {
    if (this.atWitness()) {
      const spot = this.spot!;
      const owner = this.drawn.ownerOf(spot.obstacle_face);
      if (spot.obstacle_point || owner !== null) return { point: spot.obstacle_point, owner };
    }
    return this.met && this.met.owner !== null ? { point: this.met.point, owner: this.met.owner } : null;
  }

  /** The face of the sample shown. */
  faceShown(): Owner | null {
    const found = this.meta.faces.findIndex((each) => each.number === this.sample?.face);
    return found < 0 ? null : found;
  }

  atWitness(): boolean {
    const witness = this.witness();
    return this.posture !== null && witness !== null && alike(this.posture, witness);
  }

  hover(owner: Owner | null, lit = false): void {
    if (owner === this.hot && lit === this.lit) return;
    this.hot = owner;
    this.lit = lit;
    this.emit("hot");
  }

  showTool(shown: boolean): void {
    this.toolShown = shown;
    this.setPosture(this.posture);
  }
}

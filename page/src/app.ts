// What is shown now: cutter, colouring, sample, posture, what is lit up; and who wants to know.

import type { Clip } from "./clip.ts";
import { lookOf } from "./colours.ts";
import { place, type Placed } from "./contact.ts";
import type { Arrays } from "./decode.ts";
import { LiveTool, type Met, Probe, type State } from "./live_map.ts";
import type { Eyes } from "./eyes.ts";
import type { Drawn, Owner } from "./mesh.ts";
import { Machine } from "./machine.ts";
import type { Cutter, Meta, Operation, OperationPlan, Spot, Step, Vec } from "./meta.ts";
import type { Outline } from "./outline.ts";
import { firstMode, planOf, postureOf, PROCESS, stepOf, takenBy } from "./operations.ts";
import type { PartView } from "./part.ts";
import type { Picker } from "./pick.ts";
import { alike, type Posture, type Sample, type Samples } from "./samples.ts";
import type { Stage } from "./stage.ts";
import type { ToolView } from "./tool.ts";
import { cross, norm, turned } from "./vectors.ts";

/** Sine of an angle between tool axes that are nearly one. */
const NEAR = 1e-3;

export interface Judged {
  state: State;
  certified: boolean;
}

type Event = "cutter" | "look" | "sample" | "posture" | "hot" | "spot" | "operation" | "setup";

export class App {
  cutter: Cutter;
  /** Stands in the setup that serves the sample shown. */
  readonly machine: Machine;
  mode: string;
  sample: Sample | null = null;
  spot: Spot | null = null;
  posture: Posture | null = null;
  /** What stands in the way at the posture, and what is to be said of it. */
  met: Met | null = null;
  state: Judged | null = null;
  /** Told by the posture map, which knows what is certified. */
  judge: (posture: Posture, met: Met) => Judged = (_, met) => ({ state: met.state, certified: false });
  hot: Owner | null = null;
  toolShown = true;
  clip: Clip | null = null;
  eyes: Eyes | null = null;
  outline: Outline | null = null;
  /** What is to be added to what is said next. */
  note = "";
  private madeProbe: Probe | null = null;
  private readonly liveTools = new Map<string, LiveTool>();
  private readonly told = new Map<Event, (() => void)[]>();

  constructor(
    readonly meta: Meta,
    readonly arrays: Arrays,
    readonly samples: Samples,
    readonly drawn: Drawn,
    readonly stage: Stage,
    readonly part: PartView,
    readonly tool: ToolView,
    readonly picker: Picker,
    /** Say something in the status line, which is read out. */
    readonly say: (text: string) => void,
  ) {
    this.cutter = this.cutterOf(meta.shown);
    this.mode = firstMode(meta);
    this.machine = new Machine(meta);
  }

  on(event: Event, work: () => void): void {
    this.told.set(event, [...(this.told.get(event) ?? []), work]);
  }

  private emit(event: Event): void {
    for (const work of this.told.get(event) ?? []) work();
  }

  cutterOf(id: string): Cutter {
    return this.meta.cutters.find((each) => each.id === id) ?? this.meta.cutters[0];
  }

  get probe(): Probe {
    this.madeProbe ??= new Probe(this.drawn, this.meta, this.machine);
    return this.madeProbe;
  }

  liveTool(cutter = this.cutter): LiveTool {
    let tool = this.liveTools.get(cutter.id);
    if (!tool) {
      tool = new LiveTool(cutter, this.meta);
      this.liveTools.set(cutter.id, tool);
    }
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

  repaint(): void {
    const look = lookOf(this.meta, this.arrays, this.samples, this.mode, this.cutter.id);
    this.part.paint(look, this.standOut);
    this.look = look;
    this.emit("look");
    this.stage.request();
  }

  look: ReturnType<typeof lookOf> | null = null;

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

  private standOut: ((row: number) => boolean) | null = null;

  /** The step of the process that finishes a sample, where the process is shown. */
  stepAt(row: number): Step | null {
    const { process } = this.meta;
    return this.mode === PROCESS && process ? (process.steps[stepOf(this.arrays)(row) - 1] ?? null) : null;
  }

  /** Let some samples stand out, whatever is shown; null: none. */
  lift(mine: ((row: number) => boolean) | null): void {
    this.standOut = mine;
    if (this.look) this.part.paint(this.look, this.standOut);
    this.stage.request();
  }

  /** Tip and axis of the tool at the posture shown. */
  placed(): Placed | null {
    return this.sample && this.posture && place(this.cutter, this.sample, this.posture);
  }

  /** Show a sample with the posture found there, or with its witness. */
  select(row: number | null, spot: Spot | null = null): void {
    // A cut that was made for a hidden place ends with it.
    this.clip?.release();
    this.sample = row === null ? null : this.samples.at(row);
    this.spot = row === null ? null : (spot ?? this.spotOf(row));
    this.posture = null;
    this.met = null;
    const step = row === null ? null : this.stepAt(row);
    const planned = this.operation ?? (step?.cutter === this.cutter.id ? step : null);
    this.stand(planned?.setup ?? (row === null ? 0 : (this.samples.setup(this.cutter.id, row) ?? 0)));
    this.emit("sample");
    this.emit("operation");
    if (spot) this.emit("spot");
    this.setPosture(row === null ? null : this.startPosture(row));
  }

  /** Let the part stand in a setup, among the fixtures there. */
  stand(setup: number): void {
    this.machine.stand(setup);
    if (this.drawn.setup === setup) return;
    this.drawn.setup = setup;
    this.part.stand();
    this.clip?.stand();
    this.emit("setup");
    this.stage.request();
  }

  private spotOf(row: number): Spot | null {
    return this.meta.spots.find((each) => each.sample === row && each.cutter === this.cutter.id) ?? null;
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
    const planned = this.plannedPosture();
    if (planned) return planned;
    const found = this.samples.posture(this.cutter.id, row);
    if (found) return found;
    return this.witness();
  }

  private witness(): Posture | null {
    const { tilt_deg: tilt = null, lean_deg: lean = null } = this.spot ?? {};
    return tilt === null || lean === null ? null : { tilt, rotation: turned(lean) };
  }

  setPosture(posture: Posture | null): void {
    this.posture = posture;
    const { sample } = this;
    this.met = this.state = null;
    if (sample && posture) {
      this.tool.show(this.cutter, place(this.cutter, sample, posture));
      this.met = this.probe.look(this.liveTool(), sample, posture, true);
      this.state = this.judge(posture, this.met);
      // What is certified to be free stays so, whatever the coarse triangles say.
      if (this.state.state === "free") this.met = null;
    }
    if (!sample || !posture || !this.toolShown) this.tool.hide();
    this.emit("posture");
    this.light();
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

  /** Told of the face under the pointer; from a list, it is lit up in the picture. */
  hover(owner: Owner | null, lit = false): void {
    if (owner === this.hot && lit === this.lit) return;
    this.hot = owner;
    this.emit("hot");
    if (this.lit !== lit || lit) {
      this.lit = lit;
      this.light();
    }
  }

  private lit = false;

  private light(): void {
    const way = this.inTheWay()?.owner ?? null;
    // The face of the sample itself keeps its verdicts in view: what is in the way of it there has a mark.
    const own = way !== null && this.sample !== null && this.meta.faces[way]?.number === this.sample.face;
    this.part.light(this.lit ? this.hot : null, own ? null : way);
    this.outline?.show(way);
    this.stage.request();
  }

  showTool(shown: boolean): void {
    this.toolShown = shown;
    this.setPosture(this.posture);
  }
}

// The process made alive: a step shows its samples and its tool, and plays; a setup shows how the part stands; what stays is flown to.
// So are the plans of operations beside it: an entry lights its regions up, and shows its tool along its axis.

import type { View } from "./camera.ts";
import { STAYS } from "./colours.ts";
import { button } from "./dom.ts";
import type { Operation, OperationPlan, Pattern, Process, Step, Vec } from "./meta.ts";
import { swatch } from "./patterns.ts";
import type { Picture } from "./picture.ts";
import { modeOf, plansOf, PROCESS, stepOf, takenBy } from "./plans.ts";
import type { PageState } from "./state.ts";
import { moreOf, press } from "./tables.ts";
import { distance, dot, minus } from "./vectors.ts";
import { flyTo } from "./views.ts";

/** A step is played in so many places at most, each shown so long, ms. */
const [PLACES, EACH] = [150, 90];

export class ProcessTable {
  private readonly rows = new Map<Step, { made: HTMLElement; both: HTMLElement[] }>();
  private timer = 0;

  constructor(private readonly picture: Picture, private readonly process: Process) {
    const { state } = picture;
    const of = stepOf(state.arrays);
    for (const row of document.querySelectorAll<HTMLElement>("#process tr[data-step]")) {
      const number = Number(row.dataset.step);
      const step = process.steps[number - 1];
      if (!step) continue;
      this.rows.set(step, enliven(state, row, step, (at) => of(at) === number, () => this.show(step)));
      const more = moreOf(row)?.firstElementChild;
      if (step.sample !== null && state.meta.cutters.some(({ id }) => id === step.cutter)) {
        more?.prepend(button("\u25b6 Play", () => this.toggle(step), { class: "play copy", title: "The tool at the samples of this step, one after the other" }), " ");
      }
    }
    for (const row of document.querySelectorAll<HTMLElement>("#process tr[data-setup]")) {
      const setup = Number(row.dataset.setup);
      press(row.querySelector("th")!, () => this.stand(setup));
    }
    for (const row of document.querySelectorAll<HTMLTableRowElement>("#process tr[data-place]")) {
      press(row.querySelector("th")!, () => this.fly(row.dataset.place!.split(",").map(Number) as Vec, row.cells[1].textContent!));
    }
    for (const head of document.querySelectorAll("#left .left th")) head.prepend(swatch(STAYS.colour, STAYS.pattern), " ");
    state.on("sample", () => this.mark());
    state.on("look", () => this.mark());
    this.mark();
    picture.stage.canvas.addEventListener("pointerdown", () => this.stop());
  }

  private mark(): void {
    const { state } = this.picture;
    const shown = state.sample && state.stepAt(state.sample.row);
    for (const [step, { made, both }] of this.rows) {
      both.forEach((row, k) => {
        row.classList.toggle("shown", step === shown);
        if (k) row.hidden = step !== shown;
      });
      made.setAttribute("aria-pressed", String(step === shown));
    }
  }

  /** The samples of a step stand out, and its tool stands amid them, seen askew. */
  private show(step: Step): void {
    this.stop();
    showWork(this.picture, step, PROCESS, (axis) => this.picture.stage.table.towards(axis));
  }

  /** How the part stands in a setup, from the spindle's side, among what holds it; all that is machined there stands out. */
  private stand(setup: number): void {
    const { picture, process } = this;
    const { state } = picture;
    this.stop();
    state.setMode(PROCESS);
    state.select(null);
    state.stand(setup);
    const z = state.meta.setups[setup]?.z ?? state.meta.setup.z;
    lookAt(picture, picture.stage.table.towards(z));
    const of = stepOf(state.arrays);
    state.lift((row) => process.steps[of(row) - 1]?.setup === setup);
    state.say(process.setups[setup] ?? `Setup ${setup + 1}`);
  }

  /** Fly to what stays: to the sample next to a place. */
  private fly(place: Vec, words: string): void {
    const { state } = this.picture;
    this.stop();
    state.setMode(PROCESS);
    let [row, least] = [0, Infinity];
    for (let i = 0; i < state.samples.count; i++) {
      const away = distance(state.samples.point(i) as Vec, place);
      if (away < least) [row, least] = [i, away];
    }
    flyTo(this.picture, place, state.samples.normal(row), 0.7 * state.drawn.partRadius);
    state.say(words);
  }

  private toggle(step: Step): void {
    if (this.timer) return this.stop();
    const { stage, state, tool } = this.picture;
    this.show(step);
    const of = stepOf(state.arrays);
    const number = this.process.steps.indexOf(step) + 1;
    const all = Array.from({ length: state.samples.count }, (_, row) => row).filter((row) => of(row) === number);
    const places = inOrder(state, all.filter((_, k) => k % Math.ceil(all.length / PLACES) === 0));
    let at = 0;
    this.timer = window.setInterval(() => {
      const row = places[at++];
      if (row === undefined) return this.stop();
      const placed = state.standing(state.cutter, row);
      if (placed) tool.show(state.cutter, placed);
      stage.request();
      state.say(`${step.label}: place ${at} of ${places.length}`);
    }, EACH);
  }

  /** The tool goes back to where the step shows it. */
  private stop(): void {
    if (!this.timer) return;
    window.clearInterval(this.timer);
    this.timer = 0;
    const { state } = this.picture;
    if (state.sample) state.setPosture(state.posture);
  }
}

/** Samples one after the other, each the next one to that before. */
function inOrder({ samples }: PageState, rows: number[]): number[] {
  const open = rows.map((row) => ({ row, point: samples.point(row) as Vec }));
  const found: number[] = [];
  let last = open[0];
  while (open.length) {
    let next = 0;
    open.forEach(({ point }, k) => {
      if (distance(point, last.point) < distance(open[next].point, last.point)) next = k;
    });
    [last] = open.splice(next, 1);
    found.push(last.row);
  }
  return found;
}

/** The tables of operations: an entry lights its regions up, and shows its tool along its axis. */
export class OperationTables {
  private readonly rows: { found: Operation; made: HTMLElement; both: HTMLElement[] }[] = [];

  constructor(private readonly picture: Picture) {
    const { state } = picture;
    for (const plan of plansOf(state.meta)) {
      for (const row of document.querySelectorAll<HTMLElement>(`#operations table[data-plan="${plan.key}"] tr[data-operation]`)) {
        const number = Number(row.dataset.operation);
        const found = plan.operations[number];
        if (found) this.enliven(row, plan, found, number);
      }
    }
    state.on("sample", () => this.mark());
    this.mark();
  }

  private enliven(row: HTMLElement, plan: OperationPlan, found: Operation, number: number): void {
    const taken = takenBy(plan, this.picture.state.arrays);
    const { made, both } = enliven(this.picture.state, row, found, (at) => taken(at) === number, () => this.show(plan, found));
    this.rows.push({ found, made, both });
  }

  private mark(): void {
    for (const { found, made, both } of this.rows) {
      const shown = found === this.picture.state.operation;
      for (const row of both) row.classList.toggle("shown", shown);
      made.setAttribute("aria-pressed", String(shown));
    }
  }

  /** The part turned so that the operation's axis points at the viewer, with its tool amid its region. */
  private show(plan: OperationPlan, found: Operation): void {
    showWork(this.picture, found, modeOf(this.picture.state.meta, plan), (axis) => this.picture.stage.table.facing(axis));
  }
}

/** The tool of a step or an operation amid its samples, in a view along its axis or askew to it. */
function showWork(picture: Picture, work: Step | Operation, mode: string, view: (axis: Vec) => View): void {
  const { state } = picture;
  if (state.mode !== mode) state.setMode(mode);
  if (work.sample !== null) {
    if (state.cutter.id !== work.cutter && state.meta.cutters.some(({ id }) => id === work.cutter)) state.setCutter(work.cutter);
    state.select(work.sample);
    lookAt(picture, view(state.placed()?.axis ?? state.samples.normal(work.sample)));
    // In a narrow window the picture stands above the tables.
    document.getElementById("frame")?.scrollIntoView({ block: "nearest" });
  }
  state.say(work.text);
}

/** Make a row of a step or an operation, and the one below that says more, lift its regions out, and show it at a click. */
function enliven(
  state: PageState, row: HTMLElement, look: { colour: string; pattern: Pattern }, mine: (row: number) => boolean, show: () => void,
): { made: HTMLElement; both: HTMLElement[] } {
  const more = moreOf(row);
  const both = more ? [row, more] : [row];
  const made = press(row.querySelector<HTMLElement>("th") ?? row, show);
  made.prepend(swatch(look.colour, look.pattern), " ");
  const light = (): void => state.lift(mine);
  const dark = (): void => state.lift(null);
  for (const each of both) {
    each.addEventListener("pointerenter", light);
    each.addEventListener("pointerleave", dark);
    each.addEventListener("click", (event) => {
      if (!(event.target as Element).closest("button")) show();
    });
  }
  made.addEventListener("focus", light);
  made.addEventListener("blur", dark);
  return { made, both };
}

/** Look from there at all of the part and of the tool shown. */
function lookAt({ stage: { table }, state }: Picture, view: View): void {
  const aim = table.fitted(view.turn, view.rise);
  const placed = state.placed();
  if (!placed) return table.fly(aim);
  const { up, right } = table.frame(aim);
  const away = minus(placed.tip, aim.target);
  const radius = Math.max(...state.cutter.outline.flatMap(({ points }) => points.map(([r]) => r)));
  const [across, along] = [right, up].map((way) => 1.06 * (Math.abs(dot(away, way)) + radius));
  table.fly({ ...aim, half: Math.max(aim.half, along, across / table.aspect) });
}

// The plan of operations: which operation takes a sample, how its tool stands there, and its tables made alive.

import type { App } from "./app.ts";
import type { Arrays } from "./decode.ts";
import { button, el } from "./dom.ts";
import type { View } from "./camera.ts";
import type { Meta, Operation, OperationPlan, Pattern, Vec } from "./meta.ts";
import { swatch } from "./patterns.ts";
import { type Posture, type Sample, shareOf } from "./samples.ts";
import { moreOf, press } from "./tables.ts";
import { cross, DEG, dot, minus, turned } from "./vectors.ts";

const MODE = "operation:";

/** The colouring by the steps of the process, which may be a plan of operations. */
export const PROCESS = "process";

/** What the picture shows first. */
export const firstMode = ({ process }: Meta): string => (process ? PROCESS : "verdict");

/** The colouring of a plan. */
export const modeOf = (meta: Meta, plan: OperationPlan): string => (plan.key === meta.process?.plan ? PROCESS : MODE + plan.key);

export const titleOf = ({ name }: OperationPlan): string => `${name.charAt(0).toUpperCase()}${name.slice(1)} operations`;

export const plansOf = (meta: Meta): OperationPlan[] => meta.operations?.plans ?? [];

/** The plan that a colouring shows; null for other colourings. */
export const planOf = (meta: Meta, mode: string): OperationPlan | null =>
  plansOf(meta).find((plan) => modeOf(meta, plan) === mode) ?? null;

/** The plans of operations beside the process. */
const othersOf = (meta: Meta): OperationPlan[] => plansOf(meta).filter((plan) => modeOf(meta, plan) !== PROCESS);

/** The number of the step that finishes a sample, 0 for none. */
export function stepOf(arrays: Arrays): (row: number) => number {
  const { values } = arrays.get("step");
  return (row) => values[row];
}

/** The place in a plan of the operation that takes a sample, -1 for none. */
export function takenBy(plan: OperationPlan, arrays: Arrays): (row: number) => number {
  const { values } = arrays.get(plan.array);
  return (row) => values[row] - 1;
}

/** Axes nearer to the normal may stand upright: the posture says where under the tool the sample is, degrees. */
const UPRIGHT = 1;

/** The posture of a tool axis at a sample that an operation of a plan takes. */
export function postureOf(plan: OperationPlan, arrays: Arrays, axis: Vec, sample: Sample): Posture {
  const side = cross(sample.normal, sample.direction);
  const tilt = Math.acos(Math.min(1, Math.max(-1, dot(axis, sample.normal)))) * DEG;
  const lean = Math.atan2(dot(axis, side), dot(axis, sample.direction)) * DEG;
  if (tilt >= UPRIGHT) return { tilt, rotation: turned(lean) };
  const rotation = turned(arrays.get(plan.lean).values[sample.row] / 100);
  return { tilt, rotation, ...shareOf(arrays, `operation_share.${plan.key}`, sample.row) };
}

/** What the surface shows, by mode: the process, the cutter shown alone, other plans. */
function subjects(app: App): [string, string][] {
  const { meta } = app;
  const found: [string, string][] = meta.process ? [[PROCESS, "The process"]] : [];
  found.push(["verdict", `${app.cutter.name || app.cutter.id} alone`]);
  return [...found, ...othersOf(meta).map((plan): [string, string] => [modeOf(meta, plan), titleOf(plan)])];
}

/** The line that says what is shown, with a button for each thing that can be. */
export function subjectSwitch(app: App): HTMLElement {
  const group = el("span", { class: "group", id: "show", role: "group", "aria-label": "Shown" });
  const fill = (): void => {
    const buttons = subjects(app).map(([mode, label]) =>
      button(label, () => app.setMode(mode), { title: "What the picture shows (o)", "aria-pressed": String(app.mode === mode), "data-mode": mode }),
    );
    const at = document.activeElement?.closest<HTMLElement>("#show button")?.dataset.mode;
    group.replaceChildren(el("span", {}, "Shown:"), ...buttons);
    if (at) buttons.find((each) => each.dataset.mode === at)?.focus();
  };
  app.on("look", fill);
  return group;
}

/** Show the next of these. */
export function nextSubject(app: App): void {
  const all = subjects(app);
  const [mode, label] = all[(all.findIndex(([each]) => each === app.mode) + 1) % all.length];
  app.setMode(mode);
  app.say(label);
}

/** The tables of operations: an entry lights its regions up, and shows its tool along its axis. */
export class OperationTables {
  private readonly rows: { found: Operation; made: HTMLElement; both: HTMLElement[] }[] = [];

  constructor(private readonly app: App) {
    for (const plan of plansOf(app.meta)) {
      for (const row of document.querySelectorAll<HTMLElement>(`#operations table[data-plan="${plan.key}"] tr[data-operation]`)) {
        const number = Number(row.dataset.operation);
        const found = plan.operations[number];
        if (found) this.enliven(row, plan, found, number);
      }
    }
    app.on("operation", () => this.mark());
    this.mark();
  }

  private enliven(row: HTMLElement, plan: OperationPlan, found: Operation, number: number): void {
    const taken = takenBy(plan, this.app.arrays);
    const { made, both } = enliven(this.app, row, found, (at) => taken(at) === number, () => this.show(plan, found));
    this.rows.push({ found, made, both });
  }

  private mark(): void {
    for (const { found, made, both } of this.rows) {
      const shown = found === this.app.operation;
      for (const row of both) row.classList.toggle("shown", shown);
      made.setAttribute("aria-pressed", String(shown));
    }
  }

  /** The part turned so that the operation's axis points at the viewer, with its tool amid its region. */
  private show(plan: OperationPlan, found: Operation): void {
    const { app } = this;
    if (found.sample === null) return app.say(found.text);
    if (app.mode !== modeOf(app.meta, plan)) app.setMode(modeOf(app.meta, plan));
    if (app.cutter.id !== found.cutter) app.setCutter(found.cutter);
    app.select(found.sample);
    const placed = app.placed();
    if (placed) lookAt(app, app.stage.table.facing(placed.axis));
    // In a narrow window the picture stands above the tables.
    document.getElementById("frame")?.scrollIntoView({ block: "nearest" });
    app.say(found.text);
  }
}

/** Make a row of a step or an operation, and the one below that says more, lift its regions out, and show it at a click. */
export function enliven(
  app: App, row: HTMLElement, look: { colour: string; pattern: Pattern }, mine: (row: number) => boolean, show: () => void,
): { made: HTMLElement; both: HTMLElement[] } {
  const more = moreOf(row);
  const both = more ? [row, more] : [row];
  const made = press(row.querySelector<HTMLElement>("th") ?? row, show);
  made.prepend(swatch(look.colour, look.pattern), " ");
  const light = (): void => app.lift(mine);
  const dark = (): void => app.lift(null);
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
export function lookAt(app: App, view: View): void {
  const { table } = app.stage;
  const aim = table.fitted(view.turn, view.rise);
  const placed = app.placed();
  if (!placed) return table.fly(aim);
  const { up, right } = table.frame(aim);
  const away = minus(placed.tip, aim.target);
  const radius = Math.max(...app.cutter.outline.flatMap(({ points }) => points.map(([r]) => r)));
  const [across, along] = [right, up].map((way) => 1.06 * (Math.abs(dot(away, way)) + radius));
  table.fly({ ...aim, half: Math.max(aim.half, along, across / table.aspect) });
}

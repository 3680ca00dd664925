// The plan of operations: which operation takes a sample, how its tool stands there, and its tables made alive.

import type { App } from "./app.ts";
import type { Arrays } from "./decode.ts";
import { button, el } from "./dom.ts";
import type { Meta, Operation, OperationPlan, Vec } from "./meta.ts";
import { swatch } from "./patterns.ts";
import { type Posture, type Sample, shareOf } from "./samples.ts";
import { press } from "./tables.ts";
import { cross, DEG, dot, minus, turned } from "./vectors.ts";

const MODE = "operation:";

/** The colouring of a plan. */
export const modeOf = (plan: OperationPlan): string => MODE + plan.key;

export const titleOf = ({ name }: OperationPlan): string => `${name.charAt(0).toUpperCase()}${name.slice(1)} operations`;

export const plansOf = (meta: Meta): OperationPlan[] => meta.operations?.plans ?? [];

/** The plan that a colouring shows; null for other colourings. */
export const planOf = (meta: Meta, mode: string): OperationPlan | null =>
  plansOf(meta).find((plan) => modeOf(plan) === mode) ?? null;

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

/** What the surface shows: verdicts, or the operations of a plan. */
export function operationSwitch(app: App): HTMLElement | null {
  const plans = plansOf(app.meta);
  if (!plans.length) return null;
  const choices: [string, string][] = [["verdict", "Verdicts"]];
  for (const plan of plans) choices.push([modeOf(plan), plans.length > 1 ? titleOf(plan) : "Operations"]);
  const buttons = choices.map(([mode, label]) => button(label, () => app.setMode(mode), { title: "Verdicts or operations (o)" }));
  const mark = (): void => choices.forEach(([mode], i) => buttons[i].setAttribute("aria-pressed", String(app.mode === mode)));
  app.on("look", mark);
  mark();
  return el("span", { class: "group", id: "show", role: "group", "aria-label": "Show" }, ...buttons);
}

/** Show the next of verdicts and plans. */
export function nextPlan(app: App): void {
  const modes = ["verdict", ...plansOf(app.meta).map(modeOf)];
  app.setMode(modes[(modes.indexOf(app.mode) + 1) % modes.length]);
  const plan = app.plan;
  app.say(plan ? titleOf(plan) : "Verdicts");
}

/** The tables of operations and of steps: an entry lights its regions up, and shows its tool along its axis. */
export class OperationTables {
  private readonly rows: { found: Operation; made: HTMLElement; both: HTMLElement[] }[] = [];

  constructor(private readonly app: App) {
    for (const plan of plansOf(app.meta)) {
      const of = `[data-plan="${plan.key}"]`;
      const entries = `#operations table${of} tr[data-operation], #process tr${of}[data-operation]`;
      for (const row of document.querySelectorAll<HTMLElement>(entries)) {
        const number = Number(row.dataset.operation);
        const found = plan.operations[number];
        if (found) this.enliven(row, plan, found, number);
      }
    }
    app.on("operation", () => this.mark());
    this.mark();
  }

  private enliven(row: HTMLElement, plan: OperationPlan, found: Operation, number: number): void {
    const { app } = this;
    const more = row.nextElementSibling as HTMLElement | null;
    const both = more?.classList.contains("more") ? [row, more] : [row];
    const made = press(row.querySelector<HTMLElement>("th") ?? row, () => this.show(plan, found));
    this.rows.push({ found, made, both });
    made.prepend(swatch(found.colour, found.pattern), " ");
    const light = (): void => app.lightOperation(plan, number);
    const dark = (): void => app.lightOperation(null, -1);
    for (const each of both) {
      each.addEventListener("pointerenter", light);
      each.addEventListener("pointerleave", dark);
      each.addEventListener("click", (event) => {
        if (!(event.target as Element).closest("button")) this.show(plan, found);
      });
    }
    made.addEventListener("focus", light);
    made.addEventListener("blur", dark);
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
    if (app.mode !== modeOf(plan)) app.setMode(modeOf(plan));
    if (app.cutter.id !== found.cutter) app.setCutter(found.cutter);
    app.select(found.sample);
    this.face();
    // In a narrow window the picture stands above the tables.
    document.getElementById("frame")?.scrollIntoView({ block: "nearest" });
    app.say(found.text);
  }

  /** Look along the axis of the tool shown, from its holder, at all of the part and of the tool. */
  private face(): void {
    const placed = this.app.placed();
    if (!placed) return;
    const { table } = this.app.stage;
    const { turn, rise } = table.facing(placed.axis);
    const aim = table.fitted(turn, rise);
    const { up, right } = table.frame(aim);
    const away = minus(placed.tip, aim.target);
    const radius = Math.max(...this.app.cutter.outline.flatMap(({ points }) => points.map(([r]) => r)));
    const [across, along] = [right, up].map((way) => 1.06 * (Math.abs(dot(away, way)) + radius));
    table.fly({ ...aim, half: Math.max(aim.half, along, across / table.aspect) });
  }
}

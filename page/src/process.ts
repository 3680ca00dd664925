// The process made alive: a step shows its samples and its tool, and plays; a setup shows how the part stands; what stays is flown to.

import type { App } from "./app.ts";
import { STAYS } from "./colours.ts";
import { copyButton } from "./copy.ts";
import { button } from "./dom.ts";
import type { Process, Step, Vec } from "./meta.ts";
import { enliven, lookAt, PROCESS, stepOf } from "./operations.ts";
import { swatch } from "./patterns.ts";
import { moreOf, press } from "./tables.ts";
import { distance } from "./vectors.ts";
import { flyTo } from "./view.ts";

/** A step is played in so many places at most, each shown so long, ms. */
const [PLACES, EACH] = [150, 90];

export class ProcessTable {
  private readonly rows = new Map<Step, { made: HTMLElement; both: HTMLElement[] }>();
  private timer = 0;

  constructor(
    private readonly app: App,
    private readonly process: Process,
  ) {
    const of = stepOf(app.arrays);
    for (const row of document.querySelectorAll<HTMLElement>("#process tr[data-step]")) {
      const number = Number(row.dataset.step);
      const step = process.steps[number - 1];
      if (!step) continue;
      this.rows.set(step, enliven(app, row, step, (at) => of(at) === number, () => this.show(step)));
      const more = moreOf(row)?.firstElementChild;
      if (step.sample !== null && app.meta.cutters.some(({ id }) => id === step.cutter)) {
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
    app.on("sample", () => this.mark());
    app.on("look", () => this.mark());
    this.mark();
    app.stage.canvas.addEventListener("pointerdown", () => this.stop());
  }

  private mark(): void {
    const shown = this.app.sample && this.app.stepAt(this.app.sample.row);
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
    const { app } = this;
    this.stop();
    if (app.mode !== PROCESS) app.setMode(PROCESS);
    if (step.sample === null) return app.say(step.text);
    if (app.meta.cutters.some(({ id }) => id === step.cutter) && app.cutter.id !== step.cutter) app.setCutter(step.cutter);
    app.select(step.sample);
    const axis = app.placed()?.axis ?? app.samples.normal(step.sample);
    lookAt(app, app.stage.table.towards(axis));
    // In a narrow window the picture stands above the tables.
    document.getElementById("frame")?.scrollIntoView({ block: "nearest" });
    app.say(step.text);
  }

  /** How the part stands in a setup, from the spindle's side, among what holds it; all that is machined there stands out. */
  private stand(setup: number): void {
    const { app, process } = this;
    this.stop();
    app.setMode(PROCESS);
    app.select(null);
    app.stand(setup);
    const z = app.meta.setups[setup]?.z ?? app.meta.setup.z;
    lookAt(app, app.stage.table.towards(z));
    const of = stepOf(app.arrays);
    app.lift((row) => process.steps[of(row) - 1]?.setup === setup);
    app.say(process.setups[setup] ?? `Setup ${setup + 1}`);
  }

  /** Fly to what stays: to the sample next to a place. */
  private fly(place: Vec, words: string): void {
    const { app } = this;
    this.stop();
    app.setMode(PROCESS);
    let [row, least] = [0, Infinity];
    for (let i = 0; i < app.samples.count; i++) {
      const away = distance(app.samples.point(i) as Vec, place);
      if (away < least) [row, least] = [i, away];
    }
    flyTo(app, place, app.samples.normal(row), 0.7 * app.drawn.partRadius);
    app.say(words);
  }

  private toggle(step: Step): void {
    if (this.timer) return this.stop();
    const { app } = this;
    this.show(step);
    const of = stepOf(app.arrays);
    const number = this.process.steps.indexOf(step) + 1;
    const all = Array.from({ length: app.samples.count }, (_, row) => row).filter((row) => of(row) === number);
    const places = inOrder(app, all.filter((_, k) => k % Math.ceil(all.length / PLACES) === 0));
    let at = 0;
    this.timer = window.setInterval(() => {
      const row = places[at++];
      if (row === undefined) return this.stop();
      const placed = app.standing(app.cutter, row);
      if (placed) app.tool.show(app.cutter, placed);
      app.stage.request();
      app.say(`${step.label}: place ${at} of ${places.length}`);
    }, EACH);
  }

  /** The tool goes back to where the step shows it. */
  private stop(): void {
    if (!this.timer) return;
    window.clearInterval(this.timer);
    this.timer = 0;
    if (this.app.sample) this.app.setPosture(this.app.posture);
  }
}

/** Samples one after the other, each the next one to that before. */
function inOrder({ samples }: App, rows: number[]): number[] {
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

/** What one would type is copied by a button: nobody types on the page. */
export function copyTyped(say: (text: string) => void): void {
  for (const place of document.querySelectorAll<HTMLElement>("[data-typed]")) {
    place.append(copyButton("Copy", () => place.dataset.typed!, say, "Copy what is added to the command for this"));
  }
}

// The map of one sample: what the drawn triangles show of it, and what is said of a posture.

import type { App, Judged } from "./app.ts";
import { OUTERMOST, STATES } from "./codes.ts";
import { spoken } from "./colours.ts";
import { runs } from "./contact.ts";
import { emptyGrid, fillColumn, type Grid, type Met, type State } from "./live_map.ts";
import { alike, type Posture, type Sample } from "./samples.ts";
import { apart } from "./vectors.ts";

const SLICE_MS = 14;

export class SampleMap {
  /** The verdict is that no searched rotation has a free tilt, or none that is known. */
  readonly blocked: boolean;
  readonly grid: Grid;

  constructor(
    private readonly app: App,
    readonly sample: Sample,
  ) {
    this.blocked = ["inaccessible", "undecided", "inside_bodies"].includes(this.verdict);
    this.grid = emptyGrid(app.meta);
  }

  private get verdict(): string {
    return this.app.samples.verdict(this.app.cutter.id, this.sample.row);
  }

  get complete(): boolean {
    return this.grid.done >= this.grid.rotations.length;
  }

  /** Look further for a moment; the page stays responsive. */
  advance(): void {
    const end = performance.now() + SLICE_MS;
    do fillColumn(this.grid, this.app.probe, this.app.liveTool(), this.sample);
    while (!this.complete && performance.now() < end);
  }

  /** The state of a searched rotation at a tilt of the grid; null where it is not known yet. */
  cell(column: number, row: number): State | null {
    if (column >= this.grid.done) return null;
    const state = STATES[this.grid.state[column * this.grid.tilts.length + row]];
    return this.blocked && state === "free" ? this.unsure : state;
  }

  private get unsure(): State {
    if (this.buried) return "buried";
    return this.verdict === "undecided" ? "undecided" : "tolerance";
  }

  /** Whether the sample lies under or within a body: the drawn triangles do not tell what they enclose. */
  private get buried(): boolean {
    return this.app.samples.reason(this.app.cutter.id, this.sample.row) === "buried";
  }

  /** Free intervals of the grid at a rotation. */
  free(column: number): [number, number][] {
    return runs(this.grid.tilts, (_, row) => this.cell(column, row) === "free");
  }

  /** What stands in the way at a rotation, each with how many degrees. */
  causes(column: number): Map<State, number> {
    const found = new Map<State, number>();
    for (let row = 0; row < this.grid.tilts.length; row++) {
      const state = this.cell(column, row);
      if (state && state !== "free") found.set(state, (found.get(state) ?? 0) + 1);
    }
    return found;
  }

  /** The searched rotation next to a rotation, degrees. */
  column(rotation: number): number {
    let best = 0;
    this.grid.rotations.forEach((each, i) => {
      if (apart(each, rotation) < apart(this.grid.rotations[best], rotation)) best = i;
    });
    return best;
  }

  /** The state of a posture, and whether that is certified. */
  at(posture: Posture, met: Met): Judged {
    const found = this.app.samples.posture(this.app.cutter.id, this.sample.row);
    const planned = this.app.plannedPosture();
    if ((found && alike(found, posture)) || (planned && alike(planned, posture))) return { state: "free", certified: true };
    const column = this.column(posture.rotation);
    const searched = apart(this.grid.rotations[column], posture.rotation) < 0.02;
    return { state: this.blocked && searched && met.state === "free" ? this.unsure : met.state, certified: false };
  }

  /** A blocked posture that comes near to being free: of the last cause, the one that meets least. */
  nearest(): Posture | null {
    const { grid, app } = this;
    for (const state of OUTERMOST) {
      const cells: Posture[] = [];
      grid.rotations.forEach((rotation, column) =>
        grid.tilts.forEach((tilt, row) => {
          if (this.cell(column, row) === state) cells.push({ tilt, rotation });
        }),
      );
      const step = Math.max(1, Math.ceil(cells.length / 60));
      let best: [number, Posture] | null = null;
      for (let i = 0; i < cells.length; i += step) {
        const { depth } = app.probe.look(app.liveTool(), this.sample, cells[i], true);
        if (!best || depth < best[0]) best = [depth, cells[i]];
      }
      if (best) return best[1];
    }
    return null;
  }
}

/** What is said of a posture: `free`, or what is in the way. */
export function wording(app: App, { state, certified }: Judged, met: Met | null): string {
  if (state === "free") return certified ? "free" : "nothing is met in the drawing, which is not certified";
  if (state === "undecided") return "undecided: neither called free nor known to be forbidden";
  const word = spoken(app.meta, state);
  const owner = met && met.owner !== null ? app.drawn.called(met.owner) : "";
  if (state === "fixture") return `${met?.part ?? "cutter"} meets ${owner}`;
  return owner ? `${word} with ${owner}` : `${word}: ${app.meta.causes[state].sentence}`;
}

// The map of one sample: what is certified, what the drawn triangles add to it, and what is said of a posture.

import type { App, Judged } from "./app.ts";
import { OUTERMOST, STATES } from "./codes.ts";
import { spoken } from "./colours.ts";
import { runs } from "./contact.ts";
import { emptyGrid, fillColumn, type Grid, type Met, type State } from "./live_map.ts";
import { alike, type Posture, type Sample } from "./samples.ts";
import type { Certified, StoredMaps } from "./stored_map.ts";
import { apart } from "./vectors.ts";

const SLICE_MS = 14;

export class SampleMap {
  readonly certified: Certified | null;
  readonly grid: Grid;

  constructor(
    private readonly app: App,
    stored: StoredMaps,
    readonly sample: Sample,
  ) {
    this.certified = within(app, sample, stored.of(app.cutter.id, sample.row)) ?? lost(app, sample);
    this.grid = emptyGrid(app.meta);
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
    const tilt = this.grid.tilts[row];
    if (this.freeAt(column, tilt)) return "free";
    if (column >= this.grid.done) return null;
    const state = STATES[this.grid.state[column * this.grid.tilts.length + row]];
    return this.certified && state === "free" ? this.unsure(column) : state;
  }

  private freeAt(column: number, tilt: number): boolean {
    return this.certified?.free[column].some(([low, high]) => tilt >= low && tilt <= high) ?? false;
  }

  private unsure(column: number): State {
    if (this.buried) return "buried";
    return this.certified!.undecided[column] > 0 ? "undecided" : "tolerance";
  }

  /** Whether the sample lies under or within a body: the drawn triangles do not tell what they enclose. */
  private get buried(): boolean {
    return this.app.samples.reason(this.app.cutter.id, this.sample.row) === "buried";
  }

  /** Free intervals at a rotation: the stored ones, else those of the grid. */
  free(column: number): [number, number][] {
    if (this.certified) return this.certified.free[column];
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
    if (!this.certified || !searched) return { state: met.state, certified: false };
    if (this.freeAt(column, posture.tilt)) return { state: "free", certified: true };
    return { state: met.state === "free" ? this.unsure(column) : met.state, certified: false };
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

/** Stored maps hold for any machine: what this one holds of them. */
function within(app: App, sample: Sample, found: Certified | null): Certified | null {
  const { machine } = app;
  if (!found || !machine.limited) return found;
  return { ...found, free: found.free.map((mine, k) => machine.within(mine, sample, app.meta.rotation_deg[k])) };
}

/** The verdict on a sample that is not reached is certified, too: no searched rotation has a free tilt. */
function lost(app: App, sample: Sample): Certified | null {
  const verdict = app.samples.verdict(app.cutter.id, sample.row);
  if (!["inaccessible", "undecided", "inside_bodies"].includes(verdict)) return null;
  const unsure = verdict === "undecided" ? 1 : 0;
  return { free: app.meta.rotation_deg.map(() => []), undecided: app.meta.rotation_deg.map(() => unsure) };
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

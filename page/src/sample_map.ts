// The postures of one sample, as far as the drawn triangles and the plan show them.

import { OUTERMOST, STATES } from "./codes.ts";
import { runs } from "./contact.ts";
import { emptyGrid, fillColumn, type Grid, type LiveTool, type Met, type Probe, type State } from "./live_map.ts";
import type { Meta } from "./meta.ts";
import { alike, type Posture, type Sample, type Samples } from "./samples.ts";
import { apart } from "./vectors.ts";

export interface Judged {
  state: State;
  certified: boolean;
}

const SLICE_MS = 14;

export class SampleMap {
  /** The verdict is that no searched rotation has a free tilt, or none that is known. */
  readonly blocked: boolean;
  readonly grid: Grid;
  /** The posture found at the sample. */
  readonly found: Posture | null;
  /** What a blocked posture is called at which the drawn triangles meet nothing. */
  private readonly unsure: State;

  constructor(
    readonly sample: Sample,
    meta: Meta,
    samples: Samples,
    private readonly tool: LiveTool,
    private readonly probe: Probe,
  ) {
    const { id } = tool.cutter;
    const verdict = samples.verdict(id, sample.row);
    this.blocked = ["inaccessible", "undecided", "inside_bodies"].includes(verdict);
    this.grid = emptyGrid(meta);
    this.found = samples.posture(id, sample.row);
    // Under or within a body: the drawn triangles do not show what they enclose.
    const buried = samples.reason(id, sample.row) === "buried";
    this.unsure = buried ? "buried" : verdict === "undecided" ? "undecided" : "tolerance";
  }

  get complete(): boolean {
    return this.grid.done >= this.grid.rotations.length;
  }

  /** Look further for a moment; the page stays responsive. */
  advance(): void {
    const end = performance.now() + SLICE_MS;
    do fillColumn(this.grid, this.probe, this.tool, this.sample);
    while (!this.complete && performance.now() < end);
  }

  /** The state of a searched rotation at a tilt of the grid; null where it is not known yet. */
  cell(column: number, row: number): State | null {
    if (column >= this.grid.done) return null;
    const state = STATES[this.grid.state[column * this.grid.tilts.length + row]];
    return this.blocked && state === "free" ? this.unsure : state;
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

  /** The state of a posture, and whether that is certified; `planned` is that of an operation, which is. */
  at(posture: Posture, met: Met, planned: Posture | null): Judged {
    if ([this.found, planned].some((each) => each && alike(each, posture))) return { state: "free", certified: true };
    const column = this.column(posture.rotation);
    const searched = apart(this.grid.rotations[column], posture.rotation) < 0.02;
    return { state: this.blocked && searched && met.state === "free" ? this.unsure : met.state, certified: false };
  }

  /** A blocked posture that comes near to being free: of the last cause, the one that meets least. */
  nearest(): Posture | null {
    const { grid } = this;
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
        const { depth } = this.probe.look(this.tool, this.sample, cells[i], true);
        if (!best || depth < best[0]) best = [depth, cells[i]];
      }
      if (best) return best[1];
    }
    return null;
  }
}

// Which postures are free at a sample, found from the drawn triangles: an approximation, not certified.

import type { Box3 } from "./three";
import { STATES } from "./codes.ts";
import { gouges, modeAt, place, type Placed } from "./contact.ts";
import type { Machine } from "./machine.ts";
import type { Drawn, Owner } from "./mesh.ts";
import type { Cutter, Meta, Vec } from "./meta.ts";
import { hit, reaches, type Solid, solidOf } from "./overlap.ts";
import type { Posture, Sample } from "./samples.ts";
import { across, cross, dot, minus, plus } from "./vectors.ts";

export type State = (typeof STATES)[number];

export interface Met {
  state: State;
  /** Part of the tool that meets something, and what, and where. */
  part: string | null;
  owner: Owner | null;
  point: Vec | null;
  depth: number;
}

const NOTHING: Met = { state: "free", part: null, owner: null, point: null, depth: 0 };

/** A tool as the live map takes it: each part smaller by what is allowed for. */
export class LiveTool {
  readonly solids: Solid[];
  /** Obstacles in the flutes within this distance of the contact are rear gouging. */
  readonly near: number;
  /** Depths up to this, mm, are overlooked. */
  readonly spared: number;

  constructor(readonly cutter: Cutter, meta: Meta) {
    const spared = meta.overlooked_mm;
    this.spared = spared;
    this.solids = cutter.outline.map((outline) =>
      solidOf(outline, spared - (outline.part === "flutes" ? cutter.allowance_mm : cutter.clearance_mm)),
    );
    this.near = 2 * cutter.radius;
  }
}

/** Looks what is in the way of a tool. */
export class Probe {
  private readonly index: ArrayLike<number>;
  private readonly corner = new Float64Array(9);
  private readonly ignored: boolean[];
  /** For each part, the triangle that was in the way last: it often is again. */
  private readonly last = new Map<string, number>();

  constructor(private readonly drawn: Drawn, meta: Meta, readonly machine: Machine) {
    this.index = drawn.tree.geometry.index!.array;
    this.ignored = meta.faces.map((face) => face.ignored);
  }

  /** What is the first thing to forbid a posture; `thorough` finds the deepest place of it. */
  look(tool: LiveTool, sample: Sample, posture: Posture, thorough = false): Met {
    const placed = place(tool.cutter, sample, posture);
    if (!this.machine.holds(placed.axis)) return { ...NOTHING, state: "axis_limit" };
    if (!modeAt(tool.cutter, posture.tilt)) return { ...NOTHING, state: "no_contact" };
    const met = this.obstacles(tool, sample, placed, thorough);
    // What curvature forbids may still be no deeper than is allowed: then nothing is met.
    return met.state === "rear_gouge" && gouges(tool.cutter, sample, posture) ? { ...met, state: "local_gouge" } : met;
  }

  /** What is in the way at a place, whatever the limits and the curvature. */
  obstacles(tool: LiveTool, sample: Sample, placed: Placed, thorough: boolean): Met {
    let held: Met | null = null;
    for (const solid of tool.solids) {
      const flutes = solid.part === "flutes";
      for (const rear of flutes ? [true, false] : [false]) {
        const found = this.meets(solid, placed, thorough, rear ? { sample, within: tool.near } : null);
        if (!found) continue;
        const state: State = rear ? "rear_gouge" : flutes ? "collision" : (solid.part as State);
        const met = { ...found, state: found.owner! < 0 ? "fixture" : state } as Met;
        if (met.state !== "fixture") return met;
        // A face of the part that is in the way, too, goes first.
        held ??= met;
      }
    }
    return held ?? NOTHING;
  }

  private meets(solid: Solid, placed: Placed, thorough: boolean, near: { sample: Sample; within: number } | null): Met | null {
    const { axis, tip } = placed;
    const x = across(axis);
    const y = cross(axis, x);
    const { position } = this.drawn;
    const { index, corner, ignored } = this;
    const { owner } = this.drawn;
    let best: Met | null = null;
    let fixture: Met | null = null;
    const key = `${solid.part}${near ? "!" : ""}`;
    const test = (triangle: number): boolean => {
      const belongs = owner[index[3 * triangle]];
      if (belongs >= 0 ? ignored[belongs] : !this.drawn.there(belongs)) return false;
      for (let k = 0; k < 3; k++) {
        const at = 3 * index[3 * triangle + k];
        const dx = position[at] - tip[0];
        const dy = position[at + 1] - tip[1];
        const dz = position[at + 2] - tip[2];
        corner[3 * k] = dx * x[0] + dy * x[1] + dz * x[2];
        corner[3 * k + 1] = dx * y[0] + dy * y[1] + dz * y[2];
        corner[3 * k + 2] = dx * axis[0] + dy * axis[1] + dz * axis[2];
      }
      if (!reaches(solid, corner, thorough)) return false;
      const point = plus(plus(plus(tip, x, hit.x), y, hit.y), axis, hit.h);
      if (near) {
        const away = minus(point, near.sample.point);
        if (dot(away, near.sample.normal) <= 0 || dot(away, away) > near.within ** 2) return false;
      }
      const met: Met = { state: "collision", part: solid.part, owner: belongs, point, depth: hit.depth };
      if (belongs < 0) {
        if (!fixture || fixture.depth < met.depth) fixture = met;
        return false;
      }
      if (!best || best.depth < met.depth) best = met;
      this.last.set(key, triangle);
      return !thorough;
    };
    const known = this.last.get(key);
    if (!thorough && known !== undefined && test(known)) return best;
    const middle = new Float64Array(3);
    this.drawn.tree.shapecast({
      intersectsBounds: (box: Box3) => {
        const { min, max } = box;
        middle[0] = 0.5 * (min.x + max.x) - tip[0];
        middle[1] = 0.5 * (min.y + max.y) - tip[1];
        middle[2] = 0.5 * (min.z + max.z) - tip[2];
        const [ex, ey, ez] = [0.5 * (max.x - min.x), 0.5 * (max.y - min.y), 0.5 * (max.z - min.z)];
        const h = middle[0] * axis[0] + middle[1] * axis[1] + middle[2] * axis[2];
        const half = ex * Math.abs(axis[0]) + ey * Math.abs(axis[1]) + ez * Math.abs(axis[2]);
        if (h - half >= solid.high || h + half <= solid.low) return false;
        const square = middle[0] ** 2 + middle[1] ** 2 + middle[2] ** 2 - h * h;
        const reach = solid.widest + Math.sqrt(ex * ex + ey * ey + ez * ez);
        if (square >= reach * reach) return false;
        if (near) {
          const p = near.sample.point;
          const dx = Math.max(min.x - p[0], 0, p[0] - max.x);
          const dy = Math.max(min.y - p[1], 0, p[1] - max.y);
          const dz = Math.max(min.z - p[2], 0, p[2] - max.z);
          if (dx * dx + dy * dy + dz * dz > near.within ** 2) return false;
        }
        return true;
      },
      intersectsRange: (offset: number, count: number) => {
        for (let i = offset; i < offset + count; i++) if (test(i)) return true;
        return false;
      },
    });
    return best ?? fixture;
  }
}

/** States over rotations and tilts, filled column by column. */
export interface Grid {
  rotations: number[];
  tilts: number[];
  state: Uint8Array;
  done: number;
}

export function emptyGrid(meta: Meta): Grid {
  const [low, high] = meta.tilt_deg;
  const tilts: number[] = [];
  for (let tilt = low; tilt < high; tilt += 1) tilts.push(tilt);
  tilts.push(high);
  return { rotations: meta.rotation_deg, tilts, state: new Uint8Array(meta.rotation_deg.length * tilts.length), done: 0 };
}

/** Fill one more rotation. */
export function fillColumn(grid: Grid, probe: Probe, tool: LiveTool, sample: Sample): void {
  const column = grid.done++;
  const rotation = grid.rotations[column];
  grid.tilts.forEach((tilt, i) => {
    const met = probe.look(tool, sample, { tilt, rotation });
    grid.state[column * grid.tilts.length + i] = STATES.indexOf(met.state);
  });
}

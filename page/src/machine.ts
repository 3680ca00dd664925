// Whether the machine holds a tool axis: by its plain limit, and by its rotary axes within their limits.

import { common, heldTilts, runs } from "./contact.ts";
import type { Kinematics, Meta, Vec } from "./meta.ts";
import { type Sample, Samples } from "./samples.ts";
import { cross, dot, minus, mixed, norm, plus, RAD, scaled } from "./vectors.ts";

/** As in plan_cutters.domain.kinematics. */
const PARALLEL = 1e-6;
const ON_LIMIT = 1e-9;
/** Stored intervals are cut back to the last tilt that is held, in steps of this, degrees. */
const STEP = 0.1;

export class Machine {
  /** The setup in which the part stands, counted from 0. */
  private at = 0;

  constructor(private readonly meta: Meta) {}

  /** Let the part stand in another setup. */
  stand(setup: number): void {
    this.at = setup;
  }

  private get setup(): { z: Vec; kinematics: Kinematics | null } {
    return this.meta.setups[this.at] ?? { z: this.meta.setup.z, kinematics: this.meta.kinematics };
  }

  get limited(): boolean {
    return this.meta.tilt_limit_deg !== null || this.meta.kinematics !== null;
  }

  holds(axis: Vec): boolean {
    const { tilt_limit_deg: limit } = this.meta;
    const { z, kinematics } = this.setup;
    if (limit !== null && dot(axis, z) < Math.cos(limit * RAD) - ON_LIMIT) return false;
    return kinematics === null || turnsTo(kinematics, axis);
  }

  /** What of free intervals (degrees) at a rotation the machine holds. */
  within(free: [number, number][], sample: Sample, rotation: number): [number, number][] {
    const { tilt_limit_deg: limit, tilt_deg } = this.meta;
    const { z, kinematics } = this.setup;
    let left = free;
    if (limit !== null) left = common(left, heldTilts(sample, rotation, z, limit, tilt_deg));
    if (kinematics === null) return left;
    const lean = Samples.lean(sample, rotation);
    const held = (tilt: number): boolean =>
      turnsTo(kinematics, mixed(sample.normal, Math.cos(tilt * RAD), lean, Math.sin(tilt * RAD)));
    return left.flatMap(([low, high]) => runs(stepped(low, high), held));
  }
}

/** Tilts of an interval in steps, both ends included. */
function stepped(low: number, high: number): number[] {
  const steps = Math.max(1, Math.ceil((high - low) / STEP - 1e-9));
  return Array.from({ length: steps + 1 }, (_, i) => (i === steps ? high : low + i * STEP));
}

/** Whether rotary axes turn the tool to an axis: a = R(d1, angle1) R(d2, angle2) t, both solutions, by whole turns. */
export function turnsTo({ direction, limit_deg, tool }: Kinematics, axis: Vec): boolean {
  if (direction.length === 0) return norm(cross(axis, tool)) <= PARALLEL && dot(axis, tool) > 0;
  const [first, second] = direction;
  const along = dot(first, axis);
  if (direction.length === 1) {
    return Math.abs(along - dot(first, tool)) <= PARALLEL && inTurns(about(first, tool, axis).angle, limit_deg[0]);
  }
  // The component along the first axis is a wave of the second one's angle.
  const inner = dot(second, tool);
  const across = minus(tool, scaled(second, inner));
  const sideways = cross(second, tool);
  const [u, v] = [dot(first, across), dot(first, sideways)];
  const share = (along - inner * dot(first, second)) / Math.hypot(u, v);
  if (!(Math.abs(share) <= 1 + 1e-12)) return false;
  const swing = Math.acos(Math.min(1, Math.max(-1, share)));
  const start = Math.atan2(v, u);
  return [start + swing, start - swing].some((angle) => {
    if (!inTurns(angle, limit_deg[1])) return false;
    const turned = plus(plus(scaled(second, inner), across, Math.cos(angle)), sideways, Math.sin(angle));
    const last = about(first, turned, axis);
    // Along the first axis any angle of it serves.
    return last.size <= PARALLEL ** 4 || inTurns(last.angle, limit_deg[0]);
  });
}

/** The angle by which a vector turns about a direction into another, rad, and the squared length of what turns. */
function about(direction: Vec, from: Vec, to: Vec): { angle: number; size: number } {
  const over = dot(direction, cross(from, to));
  const inner = dot(from, to) - dot(direction, from) * dot(direction, to);
  return { angle: Math.atan2(over, inner), size: over * over + inner * inner };
}

function inTurns(angle: number, [low, high]: [number | null, number | null]): boolean {
  if (low === null || high === null) {
    // One end alone can always be met by more turns.
    return true;
  }
  const turn = 2 * Math.PI;
  const [from, to] = [low * RAD, high * RAD];
  if (to - from >= turn) return true;
  return angle + turn * Math.ceil((from - ON_LIMIT - angle) / turn) <= to + ON_LIMIT;
}

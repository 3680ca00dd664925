// Whether the machine holds a tool axis: by its plain limit, and by its rotary axes within their limits.

import { ON_LIMIT, PARALLEL } from "./codes.ts";
import type { Kinematics, Meta, Vec } from "./meta.ts";
import { cross, DEG, dot, minus, norm, plus, RAD, scaled } from "./vectors.ts";

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

  /** The rotary axes in the setup in which the part stands; null where the machine is not known by them. */
  get kinematics(): Kinematics | null {
    return this.setup.kinematics;
  }

  /** Positions of the rotary axes that hold a tool axis: those within the limits first, then the smaller angles, as the plan takes them. */
  positions(axis: Vec): Position[] {
    const size = ({ angles, within }: Position): number =>
      (within.every(Boolean) ? 0 : 1e6) + angles.reduce((sum, angle) => sum + Math.abs(angle), 0);
    const found = this.kinematics ? positions(this.kinematics, axis).sort((a, b) => size(a) - size(b)) : [];
    // Where the two are one position, it is told once.
    return found.filter((each, i) => i === 0 || each.angles.some((angle, k) => Math.abs(angle - found[0].angles[k]) > 1e-4));
  }

  holds(axis: Vec): boolean {
    const { tilt_limit_deg: limit } = this.meta;
    const { z, kinematics } = this.setup;
    if (limit !== null && dot(axis, z) < Math.cos(limit * RAD) - ON_LIMIT) return false;
    return kinematics === null || turnsTo(kinematics, axis);
  }
}

/** A position of the rotary axes. */
export interface Position {
  /** Degrees, the axis next to the part first, each in the turn nearest to 0 within its limits if one is. */
  angles: number[];
  /** Which angles are within their limits. */
  within: boolean[];
  /** The tool axis lies along the axis next to the part: any angle of it serves. */
  free: boolean;
}

/** Whether rotary axes turn the tool to an axis. */
export const turnsTo = (kinematics: Kinematics, axis: Vec): boolean =>
  positions(kinematics, axis).some(({ within }) => within.every(Boolean));

/** Both solutions of a = R(d1, angle1) R(d2, angle2) t, whatever the limits; of fewer axes one; none where none turns there. */
function positions({ direction, limit_deg, tool }: Kinematics, axis: Vec): Position[] {
  if (direction.length === 0) return norm(cross(axis, tool)) <= PARALLEL && dot(axis, tool) > 0 ? [position([], [])] : [];
  const [first, second] = direction;
  const along = dot(first, axis);
  if (direction.length === 1) {
    return Math.abs(along - dot(first, tool)) <= PARALLEL ? [position([about(first, tool, axis).angle], limit_deg)] : [];
  }
  // The component along the first axis is a wave of the second one's angle.
  const inner = dot(second, tool);
  const across = minus(tool, scaled(second, inner));
  const sideways = cross(second, tool);
  const [u, v] = [dot(first, across), dot(first, sideways)];
  const share = (along - inner * dot(first, second)) / Math.hypot(u, v);
  if (!(Math.abs(share) <= 1 + 1e-12)) return [];
  const swing = Math.acos(Math.min(1, Math.max(-1, share)));
  const start = Math.atan2(v, u);
  return [start + swing, start - swing].map((angle) => {
    const turned = plus(plus(scaled(second, inner), across, Math.cos(angle)), sideways, Math.sin(angle));
    const last = about(first, turned, axis);
    const found = position([last.angle, angle], limit_deg);
    if (last.size > PARALLEL ** 4) return found;
    const [low, high] = limit_deg[0];
    const still = Math.min(Math.max(0, low ?? -Infinity), high ?? Infinity);
    return { angles: [still, found.angles[1]], within: [true, found.within[1]], free: true };
  });
}

function position(angles: number[], limit: [number | null, number | null][]): Position {
  const turned = angles.map((angle, k) => inTurns(angle, limit[k]));
  return {
    angles: turned.map((found, k) => (found ?? angles[k]) * DEG),
    within: turned.map((found) => found !== null),
    free: false,
  };
}

/** The angle by which a vector turns about a direction into another, rad, and the squared length of what turns. */
function about(direction: Vec, from: Vec, to: Vec): { angle: number; size: number } {
  const over = dot(direction, cross(from, to));
  const inner = dot(from, to) - dot(direction, from) * dot(direction, to);
  return { angle: Math.atan2(over, inner), size: over * over + inner * inner };
}

/** The turn of an angle, rad, that lies within limits, the one nearest to 0; null where none does. */
function inTurns(angle: number, [low, high]: [number | null, number | null]): number | null {
  const turn = 2 * Math.PI;
  const least = low === null ? -Infinity : Math.ceil((low * RAD - ON_LIMIT - angle) / turn);
  const most = high === null ? Infinity : Math.floor((high * RAD + ON_LIMIT - angle) / turn);
  return least <= most ? angle + turn * Math.min(Math.max(0, least), most) : null;
}

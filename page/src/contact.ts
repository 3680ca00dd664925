// Where a tool stands when it touches at a posture, and where the surface curves more than it there.

import type { Cutter, Mode, Vec } from "./meta.ts";
import { type Posture, type Sample, Samples } from "./samples.ts";
import { mixed, plus, RAD } from "./vectors.ts";

export interface Placed {
  tip: Vec;
  axis: Vec;
}

const HAIR = 1e-6;
/** Curvatures are stored in half precision: a ball that just fits must not fail by that. */
const ROUNDING = 1e-3;

/** The mode in which a cutter touches at a tilt, degrees; null where it touches in none. */
export function modeAt(cutter: Cutter, tilt: number): Mode | null {
  return cutter.modes.find((mode) => tilt >= mode.tilt_low_deg - HAIR && tilt <= mode.tilt_high_deg + HAIR) ?? null;
}

/** Tip and axis of the tool that touches a sample; where it touches nowhere, as its last mode would. */
export function place(cutter: Cutter, sample: Sample, posture: Posture): Placed {
  const mode = modeAt(cutter, posture.tilt) ?? cutter.modes[cutter.modes.length - 1];
  const lean = Samples.lean(sample, posture.rotation);
  const cosine = Math.cos(posture.tilt * RAD);
  const sine = Math.sin(posture.tilt * RAD);
  const axis = mixed(sample.normal, cosine, lean, sine);
  const outward = mixed(lean, cosine, sample.normal, -sine);
  const contact = posture.shift ? plus(sample.point, posture.shift, 1) : sample.point;
  const centre = plus(contact, sample.normal, mode.radius + cutter.allowance_mm);
  return { tip: plus(plus(centre, outward, -mode.offset * (posture.share ?? 1)), axis, -mode.height), axis };
}

/** Least and largest tilt (rad) that the curvature leaves at a rotation (rad); null where it leaves none. */
export function gougeBounds(
  [most, least]: [number, number],
  rotation: number,
  offset: number,
  radius: number,
): [number, number] | null {
  const c = Math.cos(rotation);
  const s = Math.sin(rotation);
  let side = most * s * s + least * c * c;
  if (radius > 0) {
    if (offset === 0) return radius * most <= 1 + ROUNDING ? [0, Math.PI] : null;
    const room = 1 - radius * (most * c * c + least * s * s);
    if (room <= 0) return null;
    side += (((most - least) * s * c) ** 2 * radius) / room;
    const left = 1 - radius * side;
    if (offset < 0) {
      const bound = (offset * side) / left;
      return [0, left >= 0 || bound >= 1 ? Math.PI : Math.asin(bound)];
    }
    if (left <= 0) return side <= 0 ? [0, Math.PI] : null;
    side /= left;
  }
  const bound = offset * side;
  if (bound <= ROUNDING) return [0, Math.PI];
  return bound > 1 ? null : [Math.asin(bound), Math.PI - Math.asin(bound)];
}

/** Whether the surface curves more than the tool at a posture: then it gouges, however little. */
export function gouges(cutter: Cutter, sample: Sample, posture: Posture): boolean {
  if (!Number.isFinite(sample.curvature[0]) || !Number.isFinite(sample.curvature[1])) return false;
  const mode = modeAt(cutter, posture.tilt);
  if (!mode) return false;
  const radius = mode.radius + cutter.allowance_mm;
  const bounds = gougeBounds(sample.curvature, posture.rotation * RAD, mode.offset, radius);
  return !bounds || posture.tilt * RAD < bounds[0] - HAIR || posture.tilt * RAD > bounds[1] + HAIR;
}

/** The parts of ascending tilts that are held, each ending at tilts that are. */
export function runs(tilts: number[], held: (tilt: number, row: number) => boolean): [number, number][] {
  const found: [number, number][] = [];
  let open = false;
  tilts.forEach((tilt, row) => {
    const now = held(tilt, row);
    if (now && !open) found.push([tilt, tilt]);
    else if (now) found[found.length - 1][1] = tilt;
    open = now;
  });
  return found;
}

// Where one looks from: a turntable about the setup axis, in parallel projection.

import { Matrix4, OrthographicCamera, Vector3 } from "./three";
import type { Vec } from "./meta.ts";
import { across, cross, DEG, dot, mixed, plus, RAD, scaled, unit } from "./vectors.ts";

/** A circle about an axis, or a ball where there is none: what a view is to hold. */
export interface Ring {
  centre: Vec;
  radius: number;
  axis: Vec | null;
}

/** A direction to look from: the turn about the setup axis and the height over its plane, degrees. */
export interface View {
  turn: number;
  rise: number;
}

export interface Aim extends View {
  target: Vec;
  /** Half of the height that is seen, mm. */
  half: number;
}

/** The standard views by key, as [name, turn, rise]. */
export const VIEWS: Record<string, [string, number, number]> = {
  "1": ["front", -90, 0],
  "2": ["back", 90, 0],
  "3": ["left", 180, 0],
  "4": ["right", 0, 0],
  "5": ["top", -90, 90],
  "6": ["bottom", -90, -90],
  "7": ["corner", -50, 32],
};

const FLIGHT_MS = 320;

/** Whether the system asks for no motion. */
export const quiet = (): boolean => matchMedia("(prefers-reduced-motion: reduce)").matches;

export class Turntable {
  readonly camera = new OrthographicCamera();
  aim: Aim;
  /** Width of the picture over its height. */
  aspect = 1;
  private flight = 0;
  private moved = false;
  private readonly x: Vec;
  private readonly y: Vec;

  constructor(
    /** What points up: the setup axis. */
    readonly z: Vec,
    x: Vec | null,
    private readonly centre: Vec,
    /** Radius of all that is drawn, mm. */
    readonly radius: number,
    private readonly changed: () => void,
    /** All vertices, three numbers each: what is to fit into the picture. */
    private readonly vertices: () => Float32Array,
    /** What may stand out of that, mm: the longest tool. */
    private readonly beyond: number,
  ) {
    const first = x ?? (Math.abs(z[2]) > 0.9 ? [1, 0, 0] : across(z));
    this.x = unit(plus(first as Vec, z, -dot(first as Vec, z)));
    this.y = cross(z, this.x);
    this.aim = { target: centre, turn: -50, rise: 32, half: radius };
    this.apply();
  }

  /** All that is drawn, just within the picture, or within one of another shape. */
  fitted(turn: number, rise: number, aspect = this.aspect): Aim {
    const { up, right } = this.frame({ target: this.centre, turn, rise, half: 1 });
    const vertices = this.vertices();
    if (!vertices.length) return { target: this.centre, turn, rise, half: this.radius };
    let [left, bottom, most, top] = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = 0; i < vertices.length; i += 3) {
      const x = vertices[i] * right[0] + vertices[i + 1] * right[1] + vertices[i + 2] * right[2];
      const y = vertices[i] * up[0] + vertices[i + 1] * up[1] + vertices[i + 2] * up[2];
      if (x < left) left = x;
      if (x > most) most = x;
      if (y < bottom) bottom = y;
      if (y > top) top = y;
    }
    return this.around(turn, rise, [[left, most], [bottom, top]], aspect, 0.53);
  }

  /** Rings and balls, just within the picture. */
  holding(turn: number, rise: number, rings: readonly Ring[]): Aim {
    const { up, right } = this.frame({ target: this.centre, turn, rise, half: 1 });
    const ends = [right, up].map((way): [number, number] => {
      const wide = ({ radius, axis }: Ring): number => radius * (axis ? Math.sqrt(Math.max(0, 1 - dot(axis, way) ** 2)) : 1);
      const both = rings.flatMap((ring) => [-1, 1].map((sign) => dot(ring.centre, way) + sign * wide(ring)));
      return [Math.min(...both), Math.max(...both)];
    });
    return this.around(turn, rise, ends, this.aspect, 0.54, rings[0].centre);
  }

  /** A view of what lies between ends across and along the picture; `share` of it, with some room, is the half that is seen. */
  private around(turn: number, rise: number, [[left, most], [bottom, top]]: number[][], aspect: number, share: number, near = this.centre): Aim {
    const { up, right } = this.frame({ target: near, turn, rise, half: 1 });
    const shift = (along: Vec, to: number): Vec => scaled(along, to - dot(near, along));
    const target = plus(plus(near, shift(right, (left + most) / 2)), shift(up, (bottom + top) / 2));
    return { target, turn, rise, half: share * Math.max(top - bottom, (most - left) / aspect, 1e-3 * this.radius) };
  }

  resize(aspect: number): void {
    // Until one has moved, all of it is in the picture.
    this.aspect = aspect;
    if (!this.moved) this.aim = this.fitted(this.aim.turn, this.aim.rise);
    this.apply();
  }

  /** Direction from the target to the eye, and what is up in the picture. */
  frame(aim = this.aim): { back: Vec; up: Vec; right: Vec } {
    const [t, r] = [aim.turn * RAD, aim.rise * RAD];
    const level = mixed(this.x, Math.cos(t), this.y, Math.sin(t));
    const back = mixed(level, Math.cos(r), this.z, Math.sin(r));
    const up = mixed(level, -Math.sin(r), this.z, Math.cos(r));
    return { back, up, right: cross(up, back) };
  }

  apply(): void {
    this.point(this.camera, this.aim, this.aspect);
    this.changed();
  }

  /** Let a camera look as an aim says, for a picture whose width over its height is given. */
  point(camera: OrthographicCamera, aim: Aim, aspect: number): void {
    const { back, up, right } = this.frame(aim);
    const { target, half } = aim;
    const deep = 12 * this.radius + 2 * this.beyond;
    const away = 2 * deep;
    const eye = plus(target, back, away);
    camera.position.set(...eye);
    camera.quaternion.setFromRotationMatrix(
      new Matrix4().makeBasis(new Vector3(...right), new Vector3(...up), new Vector3(...back)),
    );
    camera.top = half;
    camera.bottom = -half;
    camera.left = -half * aspect;
    camera.right = half * aspect;
    camera.near = away - deep;
    camera.far = away + deep;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }

  orbit(turn: number, rise: number): void {
    this.set({ turn: this.aim.turn + turn, rise: Math.max(-90, Math.min(90, this.aim.rise + rise)) });
  }

  /** Shift the picture by shares of its height. */
  pan(x: number, y: number): void {
    const { up, right } = this.frame();
    const size = 2 * this.aim.half;
    this.set({ target: plus(plus(this.aim.target, right, -x * size), up, y * size) });
  }

  /** The least and the largest half of the height that may be seen, mm. */
  get halves(): [number, number] {
    return [1e-4 * this.radius, 20 * this.radius + this.beyond];
  }

  /** Half of the height that is seen after a zoom, mm. */
  zoomed(by: number): number {
    const [least, most] = this.halves;
    return Math.min(most, Math.max(least, this.aim.half / by));
  }

  /** Zoom about a place in the picture, -1 to 1 each way. */
  zoom(by: number, x = 0, y = 0): void {
    const half = this.zoomed(by);
    const { up, right } = this.frame();
    const moved = this.aim.half - half;
    this.set({ half, target: plus(plus(this.aim.target, right, x * moved * this.aspect), up, y * moved) });
  }

  /** Look from there at all of it, which stays in the picture until one has moved. */
  show(turn: number, rise: number): void {
    this.aim = this.fitted(turn, rise);
    this.apply();
  }

  set(part: Partial<Aim>): void {
    this.moved = true;
    cancelAnimationFrame(this.flight);
    this.aim = { ...this.aim, ...part };
    this.apply();
  }

  /** Go there in a short flight, or at once where the system asks for no motion. */
  fly(part: Partial<Aim>): void {
    this.moved = true;
    cancelAnimationFrame(this.flight);
    const from = this.aim;
    const to = { ...from, ...part };
    const turn = ((to.turn - from.turn + 540) % 360) - 180;
    if (quiet()) return this.set(part);
    // Whoever moves the picture by hand sees at once that it is not theirs any more.
    this.aim = { ...from };
    const start = performance.now();
    const step = (now: number): void => {
      const share = Math.min(1, (now - start) / FLIGHT_MS);
      const ease = share * share * (3 - 2 * share);
      this.aim = {
        target: mixed(from.target, 1 - ease, to.target, ease),
        turn: share === 1 ? to.turn : from.turn + ease * turn,
        rise: from.rise + ease * (to.rise - from.rise),
        half: from.half * (to.half / from.half) ** ease,
      };
      this.apply();
      if (share < 1) this.flight = requestAnimationFrame(step);
    };
    this.flight = requestAnimationFrame(step);
  }

  /** Fly to where all that is drawn is just within the picture. */
  fit(turn = this.aim.turn, rise = this.aim.rise): void {
    this.fly(this.fitted(turn, rise));
  }

  /** Turn and rise from which a direction points at the eye. */
  facing(direction: Vec): { turn: number; rise: number } {
    const [x, y, z] = [dot(direction, this.x), dot(direction, this.y), dot(direction, this.z)];
    const level = Math.hypot(x, y);
    const turn = level > 1e-3 ? Math.atan2(y, x) * DEG : this.aim.turn;
    return { turn, rise: Math.atan2(z, level) * DEG };
  }

  /** Turn and rise from which a direction is seen from its front, askew, so that a tool there shows its side. */
  towards(direction: Vec): { turn: number; rise: number } {
    const { turn, rise } = this.facing(direction);
    return { turn: turn + 28, rise: Math.max(-65, Math.min(55, rise > 25 ? rise - 22 : rise + 12)) };
  }
}

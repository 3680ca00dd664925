// One camera for several pictures: whichever is turned leads, and the others are drawn with it.

import { VIEWS } from "./camera.ts";
import type { Side } from "./compare_side.ts";

export class OneCamera {
  private leader: Side;

  constructor(private readonly sides: Side[]) {
    this.leader = sides[0];
    for (const side of sides) {
      side.stage.beforeDraw(() => side === this.leader && this.follow());
      for (const event of ["pointerdown", "wheel", "keydown"] as const) {
        side.stage.canvas.addEventListener(event, () => this.lead(side), { capture: true, passive: true });
      }
    }
  }

  get table(): Side["stage"]["table"] {
    return this.leader.stage.table;
  }

  /** Let a side lead from where all look now. */
  lead(side: Side): void {
    if (side === this.leader) return;
    // A flight ends where it is, and what was not drawn yet is not lost.
    this.table.set({});
    this.follow();
    this.leader = side;
  }

  fit(turn?: number, rise?: number): void {
    this.table.fit(turn, rise);
  }

  /** In the same frame, so that no eye sees two views. */
  private follow(): void {
    const { aim } = this.table;
    for (const { stage } of this.sides) {
      if (stage === this.leader.stage || stage.table.aim === aim) continue;
      const { target, turn, rise, half } = stage.table.aim;
      if (turn === aim.turn && rise === aim.rise && half === aim.half && target.every((x, k) => x === aim.target[k])) continue;
      stage.table.set(aim);
      stage.draw();
    }
  }
}

/** What keys do anywhere but in a field; arrows in a picture alone, for elsewhere they scroll. */
export function listenKeys(camera: OneCamera, step: (by: number) => void, leave: () => void): void {
  document.addEventListener("keydown", (event) => {
    const where = event.target as HTMLElement;
    if (event.defaultPrevented || event.altKey || event.metaKey || where.closest("input, select, textarea")) return;
    const arrows: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const arrow = where instanceof HTMLCanvasElement ? arrows[event.key] : undefined;
    if (arrow) {
      event.preventDefault();
      const [x, y] = arrow;
      if (event.ctrlKey) camera.table.pan(-0.08 * x, 0.08 * y);
      else camera.table.orbit(8 * x, 8 * y);
      return;
    }
    if (event.ctrlKey) return;
    const view = VIEWS[event.key];
    const works: Record<string, () => void> = {
      "+": () => camera.table.zoom(1.25),
      "=": () => camera.table.zoom(1.25),
      "-": () => camera.table.zoom(0.8),
      f: () => camera.fit(),
      n: () => step(1),
      p: () => step(-1),
      Escape: leave,
    };
    if (view) camera.fit(view[1], view[2]);
    else works[event.key]?.();
  });
}

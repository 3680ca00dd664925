// One camera for several pictures: whichever is turned leads, and the others are drawn with it. Mouse, fingers and keys.

import { VIEWS } from "./camera.ts";
import type { Side } from "./compare_side.ts";

/** A press that moves less than this, pixels, is a click. */
const STILL = 4;

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

  fit(turn = this.table.aim.turn, rise = this.table.aim.rise): void {
    this.table.fly(this.table.fitted(turn, rise));
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

/** What mouse and fingers do in a picture: turn, shift, zoom; and what they point at and choose. */
export function steer(side: Side, told: { hover: (x: number, y: number) => void; leave: () => void; choose: (x: number, y: number) => void }): void {
  const { stage } = side;
  const { canvas, table } = stage;
  const down = new Map<number, { x: number; y: number }>();
  let [pan, moved, asked] = [false, false, 0];
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pan = event.button !== 0 || event.shiftKey;
    moved = down.size > 0;
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    const from = down.get(event.pointerId);
    if (!from) {
      cancelAnimationFrame(asked);
      asked = requestAnimationFrame(() => told.hover(...stage.place(event)));
      return;
    }
    const [dx, dy] = [event.clientX - from.x, event.clientY - from.y];
    if (!moved && Math.hypot(dx, dy) < STILL) return;
    moved = true;
    const other = [...down].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      // Two fingers: what lies between them grows with their distance and goes with their middle.
      const [was, now] = [Math.hypot(from.x - other.x, from.y - other.y), Math.hypot(event.clientX - other.x, event.clientY - other.y)];
      if (was > 1 && now > 1) table.zoom(now / was);
      table.pan(dx / 2 / canvas.clientHeight, dy / 2 / canvas.clientHeight);
    } else if (pan) table.pan(dx / canvas.clientHeight, dy / canvas.clientHeight);
    else table.orbit(-0.45 * dx, 0.45 * dy);
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  const up = (event: PointerEvent): void => {
    const click = down.delete(event.pointerId) && !moved && !pan && event.type === "pointerup";
    if (click) told.choose(...stage.place(event));
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointerleave", () => {
    cancelAnimationFrame(asked);
    told.leave();
  });
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      table.zoom(Math.exp(-0.0015 * (event.deltaMode === 1 ? 16 : 1) * event.deltaY), ...stage.place(event));
    },
    { passive: false },
  );
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

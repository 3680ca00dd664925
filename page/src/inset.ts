// All of the part in a corner of the picture while the picture shows a piece of it: which piece, and where the sample is.

import { OrthographicCamera } from "./three";
import type { App } from "./app.ts";
import type { Aim } from "./camera.ts";
import { el, svg } from "./dom.ts";
import type { Vec } from "./meta.ts";
import { dot, minus } from "./vectors.ts";

/** Where the picture shows less of the part's height than this share, the inset is there. */
const NEAR = 0.75;
/** Its side as a share of the picture's shorter one, and in pixels at least and at most. */
const [SHARE, LEAST, MOST] = [0.3, 88, 180];
/** From an upper corner of the picture, pixels: below the words for what is under the pointer. */
const [BESIDE, TOP] = [8, 34];
/** Pixels around the sample that the inset leaves free. */
const FREE = 24;

export class Inset {
  readonly root = el("button", { id: "inset", type: "button", title: "Show the whole part (f)", "aria-label": "Show the whole part", hidden: true });
  private readonly marks = svg("svg", { "aria-hidden": "true" });
  private readonly camera = new OrthographicCamera();

  constructor(private readonly app: App) {
    this.root.append(this.marks as unknown as Node);
    this.root.addEventListener("click", () => {
      const { table } = app.stage;
      table.fit();
    });
    app.stage.afterDraw(() => this.draw());
  }

  private draw(): void {
    const { canvas, renderer, scene, table } = this.app.stage;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    const { aim } = table;
    const side = Math.round(Math.min(MOST, Math.max(LEAST, SHARE * Math.min(width, height))));
    this.root.hidden = aim.half > NEAR * table.fitted(aim.turn, aim.rise).half || side > 0.6 * width;
    if (this.root.hidden) return;
    const whole = table.fitted(aim.turn, aim.rise, 1);
    table.point(this.camera, whole, 1);
    const left = this.covers(side, width, height);
    this.root.classList.toggle("left", left);
    const [x, y] = [left ? BESIDE : width - side - BESIDE, height - side - TOP];
    renderer.setViewport(x, y, side, side);
    renderer.setScissor(x, y, side, side);
    renderer.setScissorTest(true);
    renderer.render(scene, this.camera);
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, width, height);
    this.mark(side, whole);
  }

  /** Whether the sample would lie below the inset in the right corner. */
  private covers(side: number, width: number, height: number): boolean {
    const { sample, stage } = this.app;
    if (!sample) return false;
    const { aim } = stage.table;
    const { right, up } = stage.table.frame(aim);
    const away = minus(sample.point, aim.target);
    const scale = height / (2 * aim.half);
    const [x, y] = [width / 2 + scale * dot(away, right), height / 2 - scale * dot(away, up)];
    return x > width - side - BESIDE - FREE && y < TOP + side + FREE;
  }

  private mark(side: number, whole: Aim): void {
    const { sample, stage } = this.app;
    const { aim, aspect } = stage.table;
    const { right, up } = stage.table.frame(aim);
    const scale = side / (2 * whole.half);
    const place = (point: Vec): [number, number] => {
      const away = minus(point, whole.target);
      return [side / 2 + scale * dot(away, right), side / 2 - scale * dot(away, up)];
    };
    const [x, y] = place(aim.target);
    const [w, h] = [scale * aim.half * aspect, scale * aim.half];
    const frame = { x: x - w, y: y - h, width: 2 * w, height: 2 * h };
    const at = sample && place(sample.point);
    const dot_ = at ? { cx: at[0], cy: at[1], r: 4 } : null;
    this.root.style.setProperty("--side", `${side}px`);
    this.marks.replaceChildren(
      svg("rect", { class: "under", ...frame }),
      svg("rect", { class: "seen", ...frame }),
      ...(dot_ ? [svg("circle", { class: "under", ...dot_ }), svg("circle", { class: "sample", ...dot_ })] : []),
    );
  }
}

// How the picture lies and how large it is: the part's axes, and a bar of a round length.

import type { App } from "./app.ts";
import { svg } from "./dom.ts";
import { axis, dot } from "./vectors.ts";

/** Length of an axis, and of the bar at most, pixels. */
const [ARM, BAR] = [24, 100];
const [WIDTH, HEIGHT] = [190, 76];
const MIDDLE: [number, number] = [WIDTH - 38, 38];

export class Scale {
  readonly root = svg("svg", { id: "scale", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, width: WIDTH, height: HEIGHT, role: "img" });

  constructor(private readonly app: Pick<App, "stage">) {
    app.stage.afterDraw(() => this.draw());
  }

  private draw(): void {
    const { canvas, table } = this.app.stage;
    const { back, right, up } = table.frame();
    const arms = [0, 1, 2]
      .map((k) => ({ k, x: dot(axis(k), right), y: dot(axis(k), up), near: dot(axis(k), back) }))
      .sort((a, b) => a.near - b.near)
      .map(({ k, x, y }) => this.arm(k, x, y));
    const pixel = (2 * table.aim.half) / Math.max(1, canvas.clientHeight);
    const length = round(BAR * pixel);
    const words = told(length);
    const [end, y] = [WIDTH - 82, HEIGHT - 8];
    const start = end - length / pixel;
    const d = `M${start} ${y - 6}V${y}H${end}V${y - 6}`;
    this.root.setAttribute("aria-label", `The part's axes, and a bar of ${words}`);
    this.root.replaceChildren(
      ...arms,
      svg("path", { class: "under", d }),
      svg("path", { class: "bar", d }),
      svg("text", { x: (start + end) / 2, y: y - 9, "text-anchor": "middle" }, words),
    );
  }

  /** An axis of the part; one that points at the eye is a dot. */
  private arm(k: number, x: number, y: number): SVGElement {
    const [cx, cy] = MIDDLE;
    const [x2, y2] = [cx + ARM * x, cy - ARM * y];
    const away = Math.max(1e-3, Math.hypot(x, y));
    // A letter stands beyond the end of its axis, beside one that is seen from its end.
    const beyond = (ARM * away + 8) / away;
    const [u, v] = away > 0.15 ? [cx + beyond * x, cy - beyond * y] : [cx + 8, cy + 8];
    return svg(
      "g",
      { class: `axis ${"xyz"[k]}` },
      svg("line", { x1: cx, y1: cy, x2, y2 }),
      svg("circle", { cx: x2, cy: y2, r: 2.2 }),
      svg("text", { x: u, y: v + 4, "text-anchor": "middle" }, "XYZ"[k]),
    );
  }
}

/** The largest of 1, 2, 5, 10, ... that is no more. */
function round(most: number): number {
  const ten = 10 ** Math.floor(Math.log10(most));
  return ten * ([5, 2].find((times) => times * ten <= most) ?? 1);
}

/** A length in the unit that suits it. */
function told(mm: number): string {
  const [value, unit] = mm >= 1000 ? [mm / 1000, "m"] : mm < 0.1 ? [mm * 1000, "\u00b5m"] : [mm, "mm"];
  return `${Number(value.toPrecision(1))} ${unit}`;
}

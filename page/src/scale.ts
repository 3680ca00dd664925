// How the picture lies and how large it is: a cube along the part's axes, whose sides are views, and a bar of a round length.

import type { App } from "./app.ts";
import { svg } from "./dom.ts";
import type { Vec } from "./meta.ts";
import { axis, cross, dot, plus } from "./vectors.ts";

/** Half a side of the cube, and the length of the bar at most, pixels. */
const [HALF, BAR] = [25, 100];
const [WIDTH, HEIGHT] = [200, 92];
const MIDDLE: [number, number] = [WIDTH - 46, 46];
/** A side that is turned away further, by this cosine, has no room for its name. */
const NAMED = 0.35;

export class Scale {
  readonly root = svg("svg", { id: "scale", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, width: WIDTH, height: HEIGHT, role: "img" });

  constructor(private readonly app: Pick<App, "stage">) {
    this.root.addEventListener("click", (event) => {
      const side = (event.target as Element).closest<SVGElement>("[data-side]")?.dataset.side;
      if (!side) return;
      const { table } = app.stage;
      const { turn, rise } = table.facing(axis("XYZ".indexOf(side[1]), side[0] === "+" ? 1 : -1));
      table.fit(turn, rise);
    });
    app.stage.afterDraw(() => this.draw());
  }

  private draw(): void {
    const { canvas, table } = this.app.stage;
    const { back, right, up } = table.frame();
    const sides = [0, 1, 2].flatMap((k) => [1, -1].map((sign) => ({ k, sign, near: sign * dot(axis(k), back) })));
    const seen = sides.filter(({ near }) => near > 1e-3).map(({ k, sign, near }) => this.side(k, sign, near, right, up));
    const pixel = (2 * table.aim.half) / Math.max(1, canvas.clientHeight);
    const length = round(BAR * pixel);
    const words = told(length);
    const [end, y] = [WIDTH - 98, HEIGHT - 8];
    const start = end - length / pixel;
    const d = `M${start} ${y - 6}V${y}H${end}V${y - 6}`;
    this.root.setAttribute("aria-label", `A cube along the part's axes, and a bar of ${words}`);
    this.root.replaceChildren(
      ...seen,
      svg("path", { class: "under", d }),
      svg("path", { class: "bar", d }),
      svg("text", { x: (start + end) / 2, y: y - 9, "text-anchor": "middle" }, words),
    );
  }

  /** A side of the cube that faces the eye. */
  private side(k: number, sign: number, near: number, right: Vec, up: Vec): SVGElement {
    const [u, v] = [axis((k + 1) % 3), cross(axis(k), axis((k + 1) % 3))];
    const at = (point: Vec): [number, number] => [MIDDLE[0] + HALF * dot(point, right), MIDDLE[1] - HALF * dot(point, up)];
    const middle = axis(k, sign);
    const corners = [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([a, b]) => at(plus(plus(middle, u, a), v, b)).join());
    const [x, y] = at(middle);
    const name = `${sign > 0 ? "+" : "-"}${"XYZ"[k]}`;
    const label = near > NAMED ? [svg("text", { x, y: y + 4, "text-anchor": "middle" }, name.replace("-", "\u2212"))] : [];
    return svg("g", { class: `side ${"xyz"[k]}`, "data-side": name }, svg("title", {}, `Look from ${name}`), svg("polygon", { points: corners.join(" ") }), ...label);
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

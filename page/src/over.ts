// What lies over the picture: axes and scale, the whole part in a corner, marks, and what is measured.

import { OrthographicCamera } from "./three";
import type { Aim } from "./camera.ts";
import { button, coordinate, el, figure, svg } from "./dom.ts";
import type { Vec } from "./meta.ts";
import type { Stage } from "./stage.ts";
import type { PageState } from "./state.ts";
import { axis, cross, distance, dot, minus, plus } from "./vectors.ts";

/** Half a side of the cube, and the length of the bar at most, pixels. */
const [HALF, BAR] = [25, 100];
const [WIDTH, HEIGHT] = [200, 92];
const MIDDLE: [number, number] = [WIDTH - 46, 46];
/** A side that is turned away further, by this cosine, has no room for its name. */
const NAMED = 0.35;

/** How the picture lies and how large it is: a cube along the axes of the part, whose sides are views, and a bar of a round length. */
export class Scale {
  readonly root = svg("svg", { id: "scale", viewBox: `0 0 ${WIDTH} ${HEIGHT}`, width: WIDTH, height: HEIGHT, role: "img" });

  constructor(private readonly stage: Stage) {
    this.root.addEventListener("click", (event) => {
      const side = (event.target as Element).closest<SVGElement>("[data-side]")?.dataset.side;
      if (!side) return;
      const { table } = stage;
      const { turn, rise } = table.facing(axis("XYZ".indexOf(side[1]), side[0] === "+" ? 1 : -1));
      table.fit(turn, rise);
    });
    stage.afterDraw(() => this.draw());
  }

  private draw(): void {
    const { canvas, table } = this.stage;
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

/** Where the picture shows less of the part's height than this share, the inset is there. */
const NEAR = 0.75;
/** Its side as a share of the picture's shorter one, and in pixels at least and at most. */
const [SHARE, LEAST, MOST] = [0.3, 88, 180];
/** From an upper corner of the picture, pixels: below the words for what is under the pointer. */
const [BESIDE, TOP] = [8, 34];
/** Pixels around the sample that the inset leaves free. */
const FREE = 24;

/** All of the part in a corner of the picture while the picture shows a piece of it: which piece, and where the sample is. */
export class Inset {
  readonly root = el("button", { id: "inset", type: "button", title: "Show the whole part (f)", "aria-label": "Show the whole part", hidden: true });
  private readonly marks = svg("svg", { "aria-hidden": "true" });
  private readonly camera = new OrthographicCamera();

  constructor(private readonly state: PageState, private readonly stage: Stage) {
    this.root.append(this.marks as unknown as Node);
    this.root.addEventListener("click", () => stage.table.fit());
    stage.afterDraw(() => this.draw());
  }

  private draw(): void {
    const { canvas, renderer, scene, table } = this.stage;
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
    const { stage, state: { sample } } = this;
    if (!sample) return false;
    const { aim } = stage.table;
    const { right, up } = stage.table.frame(aim);
    const away = minus(sample.point, aim.target);
    const scale = height / (2 * aim.half);
    const [x, y] = [width / 2 + scale * dot(away, right), height / 2 - scale * dot(away, up)];
    return x > width - side - BESIDE - FREE && y < TOP + side + FREE;
  }

  private mark(side: number, whole: Aim): void {
    const { stage, state: { sample } } = this;
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

export interface Mark {
  kind: "sample" | "obstacle" | "measure";
  points: Vec[];
  label?: string;
}

/** Marks over the picture: the sample, the obstacle and the line to it, the measured points. */
export class Marks {
  readonly root = svg("svg", { class: "marks", "aria-hidden": "true" });
  private readonly from: (() => Mark[])[] = [];

  constructor(state: PageState, private readonly stage: Stage) {
    stage.beforeDraw(() => this.draw());
    this.add(() => {
      const { sample } = state;
      if (!sample) return [];
      const { point: there = null, owner = null } = state.inTheWay() ?? {};
      const label = owner === null ? "" : `in the way: ${state.drawn.called(owner)}`;
      return [
        ...(there ? [{ kind: "obstacle", points: [sample.point, there], label } as Mark] : []),
        { kind: "sample", points: [sample.point] },
      ];
    });
  }

  /** More to mark, asked for at each drawing. */
  add(marks: () => Mark[]): void {
    this.from.push(marks);
  }

  private draw(): void {
    this.root.replaceChildren(...this.from.flatMap((marks) => marks()).flatMap((mark) => this.shapes(mark)));
  }

  private shapes({ kind, points, label }: Mark): SVGElement[] {
    const at = points.map((point) => this.stage.project(point));
    const out: SVGElement[] = [];
    if (at.length > 1) {
      const [[x1, y1], [x2, y2]] = at;
      out.push(svg("line", { class: "under", x1, y1, x2, y2 }), svg("line", { class: kind, x1, y1, x2, y2 }));
    }
    at.forEach(([cx, cy], i) => {
      if (kind === "obstacle" && i === 0) return;
      const d = `M${cx - 6} ${cy - 6}L${cx + 6} ${cy + 6}M${cx - 6} ${cy + 6}L${cx + 6} ${cy - 6}`;
      if (kind === "obstacle") out.push(svg("path", { class: "under", d }), svg("path", { class: kind, d }));
      else out.push(svg("circle", { class: "under", cx, cy, r: 6 }), svg("circle", { class: kind, cx, cy, r: 6 }));
    });
    if (label && at.length > 1) {
      // What is in the way is named on the side of its mark where the sample is not.
      const left = at[0][0] > at[1][0] && at[1][0] > 150;
      const [x, y] = kind === "obstacle" ? [at[1][0] + (left ? -12 : 12), at[1][1] + 5] : [(at[0][0] + at[1][0]) / 2 + 8, (at[0][1] + at[1][1]) / 2 - 8];
      const place = { x, y, "text-anchor": kind === "obstacle" && left ? "end" : "start" };
      out.push(svg("text", { class: "under", ...place }, label), svg("text", { class: kind, ...place }, label));
    }
    return out;
  }
}

/** Between two points of the surface, or between the selected sample and the next one selected. */
export class Measure {
  readonly root: HTMLButtonElement;
  readonly output = el("output", { id: "measured" });
  on = false;
  private points: Vec[] = [];

  constructor(private readonly state: PageState, marks: Marks, private readonly redraw: () => void) {
    this.root = button("Measure", () => this.toggle(), { "aria-pressed": "false", title: "Measure between two points (m)" });
    marks.add(() => this.marks());
    state.on("sample", () => {
      // With the keyboard: the sample that is stepped to is the second point.
      if (this.on && state.sample && this.points.length === 1) this.add(state.sample.point);
    });
  }

  toggle(): void {
    this.on = !this.on;
    this.points = [];
    this.root.setAttribute("aria-pressed", String(this.on));
    this.output.value = "";
    if (this.on && this.state.sample) this.points = [this.state.sample.point];
    this.state.say(
      !this.on
        ? "Measuring ends"
        : this.points.length
          ? "Measuring from the selected sample: select the second point"
          : "Measuring: select the first point",
    );
    this.redraw();
  }

  /** Take a point; the third one begins anew. */
  add(point: Vec): void {
    if (this.points.length === 2) this.points = [];
    this.points.push(point);
    if (this.points.length === 2) {
      this.output.value = this.words();
      this.state.say(this.output.value);
    } else {
      this.output.value = "";
      this.state.say("First point set: select the second one");
    }
    this.redraw();
  }

  private words(): string {
    const [a, b] = this.points;
    const [dx, dy, dz] = minus(b, a).map((x) => coordinate(x, 5));
    return `distance ${figure(distance(a, b), 5)} mm, dx ${dx}, dy ${dy}, dz ${dz} mm`;
  }

  private marks(): Mark[] {
    if (!this.points.length) return [];
    const label = this.points.length === 2 ? `${figure(distance(this.points[0], this.points[1]), 5)} mm` : "";
    return [{ kind: "measure", points: this.points, label }];
  }
}

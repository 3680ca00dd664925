// What is marked over the picture: the sample, the obstacle and the line to it, the measured points.

import type { App } from "./app.ts";
import { svg } from "./dom.ts";
import type { Vec } from "./meta.ts";

export interface Mark {
  kind: "sample" | "obstacle" | "measure";
  points: Vec[];
  label?: string;
}

export class Marks {
  readonly root = svg("svg", { class: "marks", "aria-hidden": "true" });
  private readonly from: (() => Mark[])[] = [];

  constructor(private readonly app: App) {
    app.stage.beforeDraw(() => this.draw());
    this.add(() => {
      const { sample } = app;
      if (!sample) return [];
      const { point: there = null, owner = null } = app.inTheWay() ?? {};
      const label = owner === null ? "" : `in the way: ${app.drawn.called(owner)}`;
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
    const at = points.map((point) => this.app.stage.project(point));
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

// Measuring between two points of the surface, or between the selected sample and the next one selected.

import type { App } from "./app.ts";
import { button, coordinate, el, figure } from "./dom.ts";
import type { Mark, Marks } from "./marks.ts";
import type { Vec } from "./meta.ts";
import { distance, minus } from "./vectors.ts";

export class Measure {
  readonly root: HTMLButtonElement;
  readonly output = el("output", { id: "measured" });
  on = false;
  private points: Vec[] = [];

  constructor(
    private readonly app: App,
    marks: Marks,
  ) {
    this.root = button("Measure", () => this.toggle(), { "aria-pressed": "false", title: "Measure between two points (m)" });
    marks.add(() => this.marks());
    app.on("sample", () => {
      // With the keyboard: the sample that is stepped to is the second point.
      if (this.on && app.sample && this.points.length === 1) this.add(app.sample.point);
    });
  }

  toggle(): void {
    this.on = !this.on;
    this.points = [];
    this.root.setAttribute("aria-pressed", String(this.on));
    this.output.value = "";
    if (this.on && this.app.sample) this.points = [this.app.sample.point];
    this.app.say(
      !this.on
        ? "Measuring ends"
        : this.points.length
          ? "Measuring from the selected sample: select the second point"
          : "Measuring: select the first point",
    );
    this.app.stage.request();
  }

  /** Take a point; the third one begins anew. */
  add(point: Vec): void {
    if (this.points.length === 2) this.points = [];
    this.points.push(point);
    if (this.points.length === 2) {
      this.output.value = this.words();
      this.app.say(this.output.value);
    } else {
      this.output.value = "";
      this.app.say("First point set: select the second one");
    }
    this.app.stage.request();
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

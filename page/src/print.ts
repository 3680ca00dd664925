// What the page prints: two stills of the picture, beside the summary and the tables.

import type { App } from "./app.ts";
import { el } from "./dom.ts";
import { legendOf } from "./legend.ts";

const SIZE = { width: 900, height: 620 };

export class Stills {
  readonly root = el("figure", { id: "stills" });
  private readonly pictures = [el("canvas", SIZE), el("canvas", SIZE)];

  private readonly key = el("div", { class: "key" });

  constructor(private readonly app: App) {
    this.pictures.forEach((picture, i) => picture.setAttribute("aria-label", `Still ${i + 1} of the part`));
    for (const picture of this.pictures) picture.setAttribute("role", "img");
    this.root.append(...this.pictures, el("figcaption", {}, "As seen on the screen, and from the opposite corner."), this.key);
    // Canvases, for a picture that is loaded anew may come too late for the printer.
    window.addEventListener("beforeprint", () => this.take());
    const why = document.querySelector<HTMLDetailsElement>("#why");
    let open = false;
    window.addEventListener("beforeprint", () => why && ([open, why.open] = [why.open, true]));
    window.addEventListener("afterprint", () => why && (why.open = open));
  }

  take(): void {
    const { stage } = this.app;
    const { table } = stage;
    const before = table.aim;
    this.key.replaceChildren(...legendOf(this.app));
    const views = [before, table.fitted(before.turn + 180, before.rise > 0 ? before.rise : 32)];
    views.forEach((aim, i) => {
      table.set(aim);
      stage.draw(false);
      const context = this.pictures[i].getContext("2d")!;
      const { canvas } = stage;
      const scale = Math.min(SIZE.width / canvas.width, SIZE.height / canvas.height);
      const [w, h] = [canvas.width * scale, canvas.height * scale];
      context.clearRect(0, 0, SIZE.width, SIZE.height);
      context.drawImage(canvas, (SIZE.width - w) / 2, (SIZE.height - h) / 2, w, h);
    });
    table.set(before);
  }
}

// What the page prints: two stills of the picture, beside the summary and the tables.

import { el } from "./dom.ts";
import { legendOf } from "./legend.ts";
import { moment } from "./notes.ts";
import type { Stage } from "./stage.ts";
import type { PageState } from "./state.ts";

/** The file's date is told in whole seconds, and a page may be loaded slowly. */
const UNSURE_MS = 5000;
const SIZE = { width: 900, height: 620 };

export class Stills {
  readonly root = el("figure", { id: "stills" });
  private readonly pictures = [el("canvas", SIZE), el("canvas", SIZE)];

  private readonly key = el("div", { class: "key" });
  private readonly dated = el("p", { id: "printed" });

  constructor(private readonly state: PageState, private readonly stage: Stage) {
    this.pictures.forEach((picture, i) => picture.setAttribute("aria-label", `Still ${i + 1} of the part`));
    for (const picture of this.pictures) picture.setAttribute("role", "img");
    this.root.append(...this.pictures, el("figcaption", {}, "As seen on the screen, and from the opposite corner."), this.key);
    // Canvases, for a picture that is loaded anew may come too late for the printer.
    window.addEventListener("beforeprint", () => this.take());
    // Nothing is folded on paper; afterwards the page is as it was.
    let folded: HTMLDetailsElement[] = [];
    window.addEventListener("beforeprint", () => {
      folded = [...document.querySelectorAll<HTMLDetailsElement>("details:not([open])")].filter((each) => !each.closest("#viewer"));
      for (const each of folded) each.open = true;
      this.dated.textContent = dates();
    });
    window.addEventListener("afterprint", () => {
      for (const each of folded) each.open = false;
    });
    document.querySelector("#summary .first")?.after(this.dated);
  }

  take(): void {
    const { stage } = this;
    const { table } = stage;
    const before = table.aim;
    this.key.replaceChildren(...legendOf(this.state));
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

/** When this paper was printed, and of when the file of the page is, where that is known. */
function dates(): string {
  const file = new Date(document.lastModified);
  // Where nobody knows, browsers give the moment at which the page was loaded.
  const known = performance.timeOrigin - file.getTime() > UNSURE_MS;
  return `Printed ${moment(new Date())}${known ? `; the file of this page is of ${moment(file)}` : ""}.`;
}

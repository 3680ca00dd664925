// Faces that are picked to be named: they are tinted in the picture, and are copied as text.

import { DoubleSide, Group, Mesh } from "./three";
import type { App } from "./app.ts";
import { copyButton } from "./copy.ts";
import { button, el } from "./dom.ts";
import type { Owner } from "./mesh.ts";
import { plainMaterial } from "./shading.ts";

export class Selection {
  readonly root = el("div", { id: "selection", role: "group", "aria-label": "Selected faces" });
  private readonly picked = new Set<Owner>();
  private readonly tints = new Group();
  private readonly material = plainMaterial("0.45, 0.12, 0.85, 0.5", { transparent: true, side: DoubleSide, depthWrite: false });
  private readonly words = el("output", {});
  private readonly boxes = new Map<Owner, HTMLInputElement>();

  constructor(private readonly app: App) {
    this.root.append(
      el("span", {}, "Selected: "),
      this.words,
      copyButton("Copy faces", () => this.text, app.say, "Copy faces: the selected ones as text, as a choice of faces is written"),
      button("Clear", () => this.clear()),
    );
    app.stage.add(this.tints);
    this.show();
  }

  /** Such as `F1,3-5`, as a choice of faces is written. */
  get text(): string {
    return ranges([...this.picked].map((owner) => this.app.meta.faces[owner].number));
  }

  toggle(owner: Owner | null): void {
    const face = owner === null ? undefined : this.app.meta.faces[owner];
    if (owner === null || !face) return this.app.say("No face is there to select");
    if (!this.picked.delete(owner)) this.picked.add(owner);
    this.show();
    this.app.say(`${face.id} is ${this.picked.has(owner) ? "selected" : "no longer selected"}${this.picked.size ? `: ${this.text}` : ""}`);
  }

  private clear(): void {
    this.picked.clear();
    this.show();
    this.app.say("No face is selected");
  }

  private show(): void {
    this.root.hidden = this.picked.size === 0;
    this.words.value = this.text;
    for (const [owner, box] of this.boxes) box.checked = this.picked.has(owner);
    this.tints.clear();
    for (const owner of this.picked) this.tints.add(this.tinted(owner));
    this.app.stage.request();
  }

  // Kept: their vertices are those of the part, which go with a geometry that is disposed of.
  private readonly meshes = new Map<Owner, Mesh>();

  private tinted(owner: Owner): Mesh {
    const { start, count } = this.app.meta.faces[owner];
    const mesh = this.meshes.get(owner) ?? new Mesh(this.app.drawn.geometry(start, count), this.material);
    this.meshes.set(owner, mesh);
    return mesh;
  }

  /** A box in each row of the table of faces, once the rows are alive. */
  tabled(): void {
    for (const row of document.querySelectorAll<HTMLElement>("#faces tr[data-face]")) {
      const owner = this.app.meta.faces.findIndex((face) => face.number === Number(row.dataset.face));
      if (owner < 0) continue;
      const box = el("input", { type: "checkbox", "aria-label": `Select ${this.app.meta.faces[owner].id}` });
      box.addEventListener("change", () => this.toggle(owner));
      row.querySelector("th")!.prepend(box);
      this.boxes.set(owner, box);
    }
  }
}

/** Numbers of faces as text. */
export function ranges(numbers: number[]): string {
  const runs: number[][] = [];
  for (const number of [...numbers].sort((a, b) => a - b)) {
    const last = runs[runs.length - 1];
    if (last && last[last.length - 1] + 1 === number) last.push(number);
    else runs.push([number]);
  }
  const told = runs.map((run) => (run.length > 2 ? `${run[0]}-${run[run.length - 1]}` : run.join(",")));
  return told.length ? `F${told.join(",")}` : "";
}

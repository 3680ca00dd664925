// The tables and lists of the page, made alive: cutters switch, spots fly the camera, faces light up and are selected.

import { DoubleSide, Group, Mesh } from "./three";
import { spoken } from "./colours.ts";
import { button, copyButton, el } from "./dom.ts";
import { NARROW } from "./legend.ts";
import type { Owner } from "./mesh.ts";
import type { Picture } from "./picture.ts";
import { PROCESS } from "./plans.ts";
import { plainMaterial } from "./shading.ts";
import type { Stage } from "./stage.ts";
import type { PageState } from "./state.ts";
import { filterTools, holds, moreOf, press, sortable } from "./tables.ts";
import { showFace, showSpot } from "./views.ts";

/** Names of so many letters are never broken. */
const SHORT = 24;
/** From so many rows on a table has a box that filters them. */
const MANY = 6;
/** From so many on cutters that finish like the one shown are folded; so many faces are shown, and on a phone. */
const [FEW, FACES, NARROWLY] = [4, 20, 6];

/** Rows of a table that are folded on the screen until a button shows them; whoever filters sees those that fit. */
function fold(table: HTMLTableElement, rows: HTMLElement[], label: string): void {
  for (const row of rows) row.classList.add("rest");
  table.classList.add("folded");
  const more = button(label, () => unfold(), { class: "unfold" });
  const unfold = (): void => {
    table.classList.remove("folded");
    more.remove();
  };
  table.after(more);
  table.parentElement!.addEventListener("input", unfold, { once: true });
}

/** One line a cutter, the one that is shown on top; more of it on opening. */
export function enhanceCutters(state: PageState): void {
  const table = document.querySelector<HTMLTableElement>("#cutters table");
  const rows = [...document.querySelectorAll<HTMLElement>("#cutters tr[data-cutter]")].filter((row) =>
    state.meta.cutters.some((each) => each.id === row.dataset.cutter),
  );
  const is = (row: HTMLElement): boolean => row.dataset.cutter === state.cutter.id;
  const buttons = new Map<HTMLElement, HTMLButtonElement>();
  const openers = new Map<HTMLElement, HTMLButtonElement>();
  const open = (row: HTMLElement, wanted: boolean): void => {
    const more = moreOf(row);
    if (more) more.hidden = !wanted;
    openers.get(row)?.setAttribute("aria-expanded", String(wanted));
  };
  const choose = (row: HTMLElement): void => {
    state.setCutter(row.dataset.cutter!);
    if (state.mode === PROCESS) state.setMode("verdict");
  };
  for (const row of rows) {
    const name = row.querySelector<HTMLElement>("th, td") ?? row;
    const more = moreOf(row);
    const said = name.textContent!.trim();
    const made = press(name, () => choose(row));
    name.classList.toggle("short", said.length <= SHORT);
    buttons.set(row, made);
    if (more) {
      const opener = button("", () => open(row, Boolean(more.hidden)), {
        class: "opener", "aria-label": `Details of ${said}`, "aria-controls": more.id, title: "Details",
      });
      openers.set(row, opener);
      name.prepend(opener);
    }
    for (const each of [row, more]) {
      each?.addEventListener("click", (event) => {
        if (!(event.target as Element).closest("button, a, summary")) choose(row);
      });
    }
  }
  const mark = (): void => {
    for (const row of rows) {
      const shown = is(row);
      row.classList.toggle("shown", shown);
      moreOf(row)?.classList.toggle("shown", shown);
      buttons.get(row)!.setAttribute("aria-pressed", String(shown));
      // While the process is shown, no cutter is the subject.
      open(row, shown && state.mode !== PROCESS);
      if (!shown || row.previousElementSibling === null) continue;
      // A row that is moved loses the focus.
      const focused = row.contains(document.activeElement) ? (document.activeElement as HTMLElement) : null;
      const more = moreOf(row);
      row.parentElement!.prepend(...(more ? [row, more] : [row]));
      focused?.focus({ preventScroll: true });
    }
    for (const more of document.querySelectorAll<HTMLDetailsElement>("#cutters details[data-cutter]")) {
      more.open = more.dataset.cutter === state.cutter.id && state.mode !== PROCESS;
      more.hidden = more.dataset.cutter !== state.cutter.id;
    }
  };
  state.on("cutter", mark);
  let ofProcess = state.mode === PROCESS;
  state.on("look", () => {
    if (ofProcess !== (ofProcess = state.mode === PROCESS)) mark();
  });
  mark();
  if (table && rows.length > 1) sortable(table, is);
  if (!table || rows.length < MANY) return;
  // A row that says no more than "this one finishes, too" says little.
  const also = rows.filter((row) => row.dataset.cutter !== state.meta.shown && state.meta.cutters.find(({ id }) => id === row.dataset.cutter)?.feasible);
  if (also.length >= FEW) fold(table, also, `${also.length} more also finish`);
  const feasible = new Set(state.meta.cutters.filter((each) => each.feasible).map(({ id }) => id));
  const box = el("input", { type: "checkbox" });
  const filtered = (wanted: string): number => {
    let count = 0;
    for (const row of rows) {
      const fits = holds(row, wanted) && (!box.checked || feasible.has(row.dataset.cutter!));
      count += fits ? 1 : 0;
      // The picture is of the cutter that is shown: its row stays.
      row.hidden = !fits && !is(row);
      if (row.hidden) open(row, false);
    }
    return count;
  };
  const tools = filterTools("cutters", "Filter cutters, such as D6", rows.length, filtered, box);
  if (feasible.size < rows.length) tools.append(el("label", { class: "check" }, box, "only feasible"));
  table.before(tools);
  state.on("cutter", () => tools.dispatchEvent(new Event("input")));
}

/** The worst spots of the cutter shown, stepped through with n and p. */
export class SpotList {
  private readonly items = [...document.querySelectorAll<HTMLElement>("#spots [data-spot]")];
  private readonly none = el("p", { class: "hint" }, "The cutter that is shown has none.");
  private at = -1;

  constructor(private readonly picture: Picture) {
    const { state } = picture;
    for (const item of this.items) press(item, () => this.show(item));
    const section = document.getElementById("spots");
    if (this.items.length) section?.append(this.none);
    const heading = section?.querySelector("h2");
    if (heading && this.items.length) {
      heading.after(
        el(
          "p",
          { class: "tools" },
          button("Previous", () => this.step(-1), { title: "Previous spot (p)" }),
          button("Next", () => this.step(1), { title: "Next spot (n)" }),
        ),
      );
    }
    state.on("cutter", () => this.filter());
    state.on("sample", () => this.mark());
    this.filter();
  }

  private get mine(): HTMLElement[] {
    return this.items.filter((item) => item.dataset.cutter === this.picture.state.cutter.id);
  }

  private filter(): void {
    this.at = -1;
    const { cutter } = this.picture.state;
    for (const more of document.querySelectorAll<HTMLDetailsElement>("#spots details[data-cutter]")) {
      more.hidden = more.dataset.cutter !== cutter.id;
      more.open = !more.hidden && !NARROW.matches;
    }
    this.none.hidden = this.mine.length > 0;
  }

  private mark(): void {
    const { meta, spot } = this.picture.state;
    for (const item of this.items) {
      const shown = spot !== null && meta.spots[Number(item.dataset.spot)] === spot;
      item.classList.toggle("shown", shown);
      if (shown) this.at = this.mine.indexOf(item);
    }
  }

  step(by: number): void {
    const { mine } = this;
    if (!mine.length) return this.picture.state.say("This cutter has no worst spots");
    this.at = this.at < 0 ? (by > 0 ? 0 : mine.length - 1) : (this.at + by + mine.length) % mine.length;
    this.show(mine[this.at]);
  }

  private show(item: HTMLElement): void {
    const { state } = this.picture;
    const spot = state.meta.spots[Number(item.dataset.spot)];
    if (!spot) return;
    // A spot is of one cutter.
    if (state.mode === PROCESS) state.setMode("verdict");
    state.select(spot.sample, spot);
    item.scrollIntoView({ block: "nearest" });
    const note = showSpot(this.picture);
    state.say(`Spot ${this.at + 1} of ${this.mine.length}: ${spot.face}, ${spoken(state.meta, spot.reason)}. ${note}`);
  }
}

export class FaceTable {
  private readonly rows = new Map<number, HTMLElement>();
  /** Rows of other tables that tell of a face. */
  private readonly others = new Map<HTMLElement, number>();
  private readonly table = document.querySelector<HTMLTableElement>("#faces table");

  constructor(picture: Picture) {
    const { state } = picture;
    const { faces } = state.meta;
    for (const row of document.querySelectorAll<HTMLElement>("tr[data-face]")) {
      const owner = faces.findIndex((face) => face.number === Number(row.dataset.face));
      if (owner < 0) continue;
      if (row.closest("#faces")) this.rows.set(owner, row);
      else this.others.set(row, owner);
      const cell = row.querySelector<HTMLElement>("th, td") ?? row;
      const made = press(cell, () => showFace(picture, owner));
      row.addEventListener("pointerenter", () => state.hover(owner, true));
      row.addEventListener("pointerleave", () => state.hover(null));
      made.addEventListener("focus", () => state.hover(owner, true));
      made.addEventListener("blur", () => state.hover(null));
    }
    state.on("hot", () => {
      for (const [owner, row] of this.rows) row.classList.toggle("hot", owner === state.hot);
      for (const [row, owner] of this.others) row.classList.toggle("hot", owner === state.hot);
    });
    this.tools();
    if (this.table) sortable(this.table);
    const beyond = [...this.rows.values()].slice(NARROW.matches ? NARROWLY : FACES);
    if (this.table && beyond.length) fold(this.table, beyond, `All ${this.rows.size} faces`);
  }

  private tools(): void {
    if (!this.table || this.rows.size < MANY) return;
    const shown = (wanted: string): number => {
      for (const row of this.rows.values()) row.hidden = !holds(row, wanted);
      return [...this.rows.values()].filter((row) => !row.hidden).length;
    };
    this.table.before(filterTools("faces", "Filter faces, such as F12", this.rows.size, shown));
  }
}

/** Faces that are picked to be named: they are tinted in the picture, and are copied as text. */
export class Selection {
  readonly root = el("div", { id: "selection", role: "group", "aria-label": "Selected faces" });
  private readonly picked = new Set<Owner>();
  private readonly tints = new Group();
  private readonly material = plainMaterial("0.45, 0.12, 0.85, 0.5", { transparent: true, side: DoubleSide, depthWrite: false });
  private readonly words = el("output", {});
  private readonly boxes = new Map<Owner, HTMLInputElement>();

  constructor(private readonly state: PageState, private readonly stage: Stage) {
    this.root.append(
      el("span", {}, "Selected: "),
      this.words,
      copyButton("Copy faces", () => this.text, state.say, "Copy faces: the selected ones as text, as a choice of faces is written"),
      button("Clear", () => this.clear()),
    );
    stage.add(this.tints);
    this.show();
  }

  /** Such as `F1,3-5`, as a choice of faces is written. */
  get text(): string {
    return ranges([...this.picked].map((owner) => this.state.meta.faces[owner].number));
  }

  toggle(owner: Owner | null): void {
    const face = owner === null ? undefined : this.state.meta.faces[owner];
    if (owner === null || !face) return this.state.say("No face is there to select");
    if (!this.picked.delete(owner)) this.picked.add(owner);
    this.show();
    this.state.say(`${face.id} is ${this.picked.has(owner) ? "selected" : "no longer selected"}${this.picked.size ? `: ${this.text}` : ""}`);
  }

  private clear(): void {
    this.picked.clear();
    this.show();
    this.state.say("No face is selected");
  }

  private show(): void {
    this.root.hidden = this.picked.size === 0;
    this.words.value = this.text;
    for (const [owner, box] of this.boxes) box.checked = this.picked.has(owner);
    this.tints.clear();
    for (const owner of this.picked) this.tints.add(this.tinted(owner));
    this.stage.request();
  }

  // Kept: their vertices are those of the part, which go with a geometry that is disposed of.
  private readonly meshes = new Map<Owner, Mesh>();

  private tinted(owner: Owner): Mesh {
    const { start, count } = this.state.meta.faces[owner];
    const mesh = this.meshes.get(owner) ?? new Mesh(this.state.drawn.geometry(start, count), this.material);
    this.meshes.set(owner, mesh);
    return mesh;
  }

  /** A box in each row of the table of faces, once the rows are alive. */
  tabled(): void {
    for (const row of document.querySelectorAll<HTMLElement>("#faces tr[data-face]")) {
      const owner = this.state.meta.faces.findIndex((face) => face.number === Number(row.dataset.face));
      if (owner < 0) continue;
      const box = el("input", { type: "checkbox", "aria-label": `Select ${this.state.meta.faces[owner].id}` });
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

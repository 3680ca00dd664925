// The page of two plans: both parts under one camera, and the tables of what changed between them.

import type { Look } from "./colours.ts";
import { facesLook, readTold, Side, type Told, verdictLook, type Word, WORDS } from "./compare_side.ts";
import { pictureKey, steer, viewSelect, zoomButtons } from "./controls.ts";
import { readArrays } from "./decode.ts";
import { button, el, percent } from "./dom.ts";
import type { Meta } from "./meta.ts";
import { swatch } from "./patterns.ts";
import { Scale } from "./over.ts";
import { schemeSwitch } from "./scheme.ts";
import { press } from "./tables.ts";

const FACES = "faces";
const ANY = "any";

/** One camera for several pictures: whichever is turned leads, and the others are drawn with it. */
class OneCamera {
  private leader: Side;

  constructor(private readonly sides: Side[]) {
    this.leader = sides[0];
    for (const side of sides) {
      side.stage.beforeDraw(() => side === this.leader && this.follow());
      for (const event of ["pointerdown", "wheel", "keydown"] as const) {
        side.stage.canvas.addEventListener(event, () => this.lead(side), { capture: true, passive: true });
      }
    }
  }

  get table(): Side["stage"]["table"] {
    return this.leader.stage.table;
  }

  /** Let a side lead from where all look now. */
  lead(side: Side): void {
    if (side === this.leader) return;
    // A flight ends where it is, and what was not drawn yet is not lost.
    this.table.set({});
    this.follow();
    this.leader = side;
  }

  /** In the same frame, so that no eye sees two views. */
  private follow(): void {
    const { aim } = this.table;
    for (const { stage } of this.sides) {
      if (stage === this.leader.stage || stage.table.aim === aim) continue;
      const { target, turn, rise, half } = stage.table.aim;
      if (turn === aim.turn && rise === aim.rise && half === aim.half && target.every((x, k) => x === aim.target[k])) continue;
      stage.table.set(aim);
      stage.draw();
    }
  }
}

class Compared {
  readonly camera: OneCamera;
  readonly status = el("p", { id: "status", role: "status" });
  private readonly legend = el("table", { class: "legend" });
  private readonly rows = [...document.querySelectorAll<HTMLElement>("#faces tbody tr")];
  private readonly again: Record<Word, Map<string, string>>;
  private readonly looks = new Map<Word, Look>();
  private mode = FACES;
  private at = -1;

  constructor(private readonly told: Told, readonly sides: Side[], viewer: HTMLElement) {
    this.again = { old: new Map(told.pairs), new: new Map(told.pairs.map(([was, now]) => [now, was])) };
    this.camera = new OneCamera(sides);
    const shut = matchMedia("(max-width: 700px)").matches;
    viewer.append(this.status);
    const legend = el("details", { id: "legend", open: !shut }, el("summary", {}, "Legend"), this.legend);
    const keys = el("p", { class: "hint" }, "Keys: n and p for changes, arrows, + and -, f to fit, 1 to 7 for views.");
    viewer.after(el("section", { id: "controls", "aria-label": "Colours and views" }, this.toolbar(), legend, keys));
    for (const side of sides) this.listen(side);
    this.rows.forEach((row, k) => {
      press(row.querySelector<HTMLElement>("th")!, () => this.show(k));
      row.addEventListener("pointerenter", () => this.light(facesOf(row)));
      row.addEventListener("pointerleave", () => this.light(this.chosen()));
    });
    const works: Record<string, () => void> = { n: () => this.step(1), p: () => this.step(-1), Escape: () => this.leave() };
    document.addEventListener("keydown", (event) => {
      const where = event.target as HTMLElement;
      if (event.defaultPrevented || event.altKey || event.metaKey || where.closest("input, select, textarea")) return;
      if (!pictureKey(event, this.camera.table, where instanceof HTMLCanvasElement) && !event.ctrlKey) works[event.key]?.();
    });
    this.paint();
  }

  private toolbar(): HTMLElement {
    const one = (value: string, label: string): HTMLElement => el("option", { value }, label);
    const colour = el(
      "select",
      { id: "colouring" },
      one(FACES, "What became of faces"),
      el("optgroup", { label: "Verdicts" }, one(ANY, "Best of all cutters"), ...this.told.cutters.map(({ name }, k) => one(String(k), name))),
    );
    colour.addEventListener("change", () => {
      this.mode = colour.value;
      this.paint();
    });
    const steps = [
      button("Previous", () => this.step(-1), { title: "Previous change (p)" }),
      button("Next", () => this.step(1), { title: "Next change (n)" }),
    ];
    return el(
      "div",
      { id: "toolbar", role: "toolbar", "aria-label": "Pictures" },
      el("label", {}, "Colour by ", colour),
      el("label", {}, "View ", viewSelect(() => this.camera.table)),
      this.rows.length ? el("span", { class: "group" }, "Changes ", ...steps) : null,
      schemeSwitch(() => undefined),
    );
  }

  private listen(side: Side): void {
    side.stage.canvas.parentElement!.append(zoomButtons(() => this.camera.table));
    steer(side.stage, {
      hover: (x, y) => {
        const id = side.faceAt(x, y);
        side.under.textContent = id === null ? "" : this.say(side.word, id);
        this.light(id === null ? this.chosen() : this.both(side.word, id));
      },
      leave: () => {
        side.under.textContent = "";
        this.light(this.chosen());
      },
      choose: (x, y) => {
        const id = side.faceAt(x, y);
        if (id === null) return this.leave();
        this.mark(this.rows.findIndex((row) => row.dataset[side.word] === id));
        this.light(this.both(side.word, id));
        this.status.textContent = this.say(side.word, id);
      },
    });
  }

  /** A face, its name in the other plan, and what became of it. */
  private say(word: Word, id: string): string {
    const { old: was, new: now } = this.both(word, id);
    const called = was && now && was !== now ? `${was}, now ${now}` : id;
    return `${called}: ${this.told.marks[this.told.states[word][id]]?.label ?? "not known"}`;
  }

  private both(word: Word, id: string): Record<Word, string | null> {
    const other = this.again[word].get(id) ?? null;
    return word === "old" ? { old: id, new: other } : { old: other, new: id };
  }

  private light(faces: Record<Word, string | null> | null): void {
    for (const side of this.sides) side.light(faces?.[side.word] ?? null);
  }

  private chosen(): Record<Word, string | null> | null {
    return this.at < 0 ? null : facesOf(this.rows[this.at]);
  }

  private mark(at: number): void {
    this.at = at;
    this.rows.forEach((row, k) => row.classList.toggle("shown", k === at));
    this.rows[at]?.scrollIntoView({ block: "nearest" });
  }

  private leave(): void {
    this.mark(-1);
    this.light(null);
    this.status.textContent = "";
  }

  /** Where the first change would be hidden, begin on the side that shows it. */
  first(): void {
    const shown = this.rows.length ? this.showing(this.rows[0]) : null;
    const aim = shown && !shown.side.sees(shown.id) ? shown.side.aimAt(shown.id) : null;
    if (aim) for (const { stage } of this.sides) stage.table.show(aim.turn, aim.rise);
  }

  /** The picture that shows a change: the new one, if it is there. */
  private showing(row: HTMLElement): { side: Side; id: string } | null {
    const faces = facesOf(row);
    for (const side of [...this.sides].reverse()) {
      const id = faces[side.word];
      if (id !== null) return { side, id };
    }
    return null;
  }

  private step(by: number): void {
    const count = this.rows.length;
    if (count) this.show(this.at < 0 ? (by > 0 ? 0 : count - 1) : (this.at + by + count) % count);
  }

  /** Look at a change in both pictures, as it is seen where it is new. */
  private show(at: number): void {
    this.mark(at);
    const faces = facesOf(this.rows[at]);
    this.light(faces);
    const [word, id] = faces.new ? (["new", faces.new] as const) : (["old", faces.old ?? ""] as const);
    const shown = this.showing(this.rows[at]);
    const aim = shown?.side.aimAt(shown.id);
    if (shown && aim) {
      this.camera.lead(shown.side);
      this.camera.table.fly(aim);
    }
    const [was, now] = [...this.rows[at].querySelectorAll("td")].map((cell) => cell.textContent);
    const said = `${this.say(word, id)}; was ${was}, now ${now}${aim ? "" : "; it is not drawn"}`;
    this.status.textContent = `Change ${at + 1} of ${this.rows.length}: ${said}`;
  }

  private paint(): void {
    const byFace = this.mode === FACES;
    const number = this.mode === ANY ? null : Number(this.mode);
    for (const side of this.sides) {
      const look = byFace ? facesLook(this.told, side) : verdictLook(this.told, side, number);
      side.paint(look, byFace);
      this.looks.set(side.word, look);
    }
    this.fill(byFace);
    this.light(this.chosen());
  }

  /** The legend, with how much of each plan has each colour. */
  private fill(byFace: boolean): void {
    const { looks } = this;
    const entries = new Map([...looks.values()].flatMap((look) => look.entries.map((each) => [each.label, each])));
    const order = Object.values(this.told.marks).map((each) => each.label);
    const labels = [...entries.keys()].sort((a, b) => order.indexOf(a) - order.indexOf(b));
    const words = WORDS.filter((word) => looks.has(word));
    const cell = (word: Word, label: string): HTMLElement => {
      const share = looks.get(word)!.entries.find((each) => each.label === label)?.share ?? 0;
      return el("td", {}, byFace ? String(share) : percent(share));
    };
    const caption = byFace ? "Number of faces" : "Share of the sampled area";
    this.legend.replaceChildren(
      el("caption", {}, caption),
      el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "Colour"), ...words.map((word) => el("th", { scope: "col" }, word)))),
      el(
        "tbody",
        {},
        ...labels.map((label) => {
          const { colour, pattern } = entries.get(label)!;
          return el("tr", {}, el("th", { scope: "row" }, swatch(colour, pattern), " ", label), ...words.map((word) => cell(word, label)));
        }),
      ),
    );
  }
}

const facesOf = (row: HTMLElement): Record<Word, string | null> => ({ old: row.dataset.old || null, new: row.dataset.new || null });

/** The box and the setup that both pictures have: those of the new plan, grown by the old one. */
function common(metas: Meta[]): Meta {
  const last = metas[metas.length - 1];
  const end = (of: "low" | "high", most: typeof Math.min): [number, number, number] =>
    [0, 1, 2].map((k) => most(...metas.map(({ part }) => part[of][k]))) as [number, number, number];
  // No tool is shown beside the parts.
  return { ...last, cutters: [], part: { ...last.part, low: end("low", Math.min), high: end("high", Math.max) } };
}

async function start(): Promise<void> {
  const viewer = document.getElementById("viewer");
  if (!viewer) return;
  performance.mark("start");
  const told = readTold();
  const sides: Side[] = [];
  for (const word of WORDS) {
    const meta = told[word];
    if (meta) sides.push(new Side(word, meta, await readArrays(meta, `data-${word}`)));
  }
  if (!sides.length) {
    document.documentElement.dataset.ready = "without";
    return;
  }
  performance.mark("decoded");
  const parts = sides.map((side) => side.drawn.shownVertices);
  const whole = new Float32Array(parts.reduce((sum, each) => sum + each.length, 0));
  parts.reduce((from, each) => (whole.set(each, from), from + each.length), 0);
  const view = common(sides.map((side) => side.meta));
  try {
    for (const side of sides) side.show(document.getElementById(side.word)!, view, () => whole);
  } catch (error) {
    for (const side of sides) side.frame.remove();
    const why = error instanceof Error ? error.message : String(error);
    viewer.prepend(el("p", { class: "none" }, `This browser shows no 3D here (${why}). The tables say what changed.`));
    document.documentElement.dataset.ready = "without";
    return;
  }
  const page = new Compared(told, sides, viewer);
  document.documentElement.classList.add("pictures");
  for (const side of sides) side.stage.begin(() => undefined);
  page.first();
  const last = sides[sides.length - 1];
  last.frame.append(new Scale(last.stage).root);
  for (const side of sides) {
    setTimeout(() => side.outline(), 0);
    // A canvas is empty on paper.
    const still = el("img", { class: "still", alt: `The ${side.word} part` });
    addEventListener("beforeprint", () => {
      still.src = side.stage.still();
      side.frame.after(still);
    });
    addEventListener("afterprint", () => still.remove());
  }
  performance.mark("interactive");
  document.documentElement.dataset.ready = "yes";
  // For scripts that ask the page: tests, and people at the console.
  Object.assign(window, { compared: page });
}

start().catch((error: unknown) => {
  const text = error instanceof Error ? error.message : String(error);
  document.getElementById("viewer")?.prepend(el("p", { class: "none" }, `The pictures cannot be shown: ${text}. The tables say what changed.`));
  document.documentElement.dataset.ready = "failed";
  console.error(error);
});

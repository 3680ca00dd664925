// What a reviewer writes: notes, each at a sample or of the whole, kept in the copy of the page that is saved.

import type { App } from "./app.ts";
import { button, el } from "./dom.ts";
import type { Vec } from "./meta.ts";
import { flyTo } from "./view.ts";

interface Note {
  text: string;
  face: string | null;
  sample: number | null;
  cutter: string | null;
}

const SECTION = "review-notes";
const DATA = "notes-data";
/** Scripts of a page must not end where a note says so. */
const ESCAPED: Record<string, string> = { "<": "\\u003c", ">": "\\u003e", "&": "\\u0026", "\u2028": "\\u2028", "\u2029": "\\u2029" };

export class Notes {
  private notes: Note[] = read();
  private saved = true;
  private readonly list = el("ol", { class: "notes" });
  private readonly box = el("textarea", { id: "note", rows: 2, "aria-describedby": "note-place" });
  private readonly place = el("span", { id: "note-place", class: "hint" });

  /** `pristine` is the page as it was loaded, before anything in it came alive. */
  constructor(
    private readonly app: App,
    private readonly pristine: HTMLElement,
  ) {
    const section = document.getElementById(SECTION);
    section?.replaceChildren(
      el("h2", {}, "Review notes"),
      el("p", { class: "hint" }, "Notes are kept in the copy that ", el("strong", {}, "Save copy"), " writes, and nowhere else."),
      this.list,
      el("label", { for: "note" }, "New note"),
      this.box,
      el("p", { class: "tools" }, button("Add note", () => this.add(), { id: "add-note" }), this.place),
    );
    this.box.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) this.add();
    });
    app.on("sample", () => this.where());
    this.where();
    this.show();
    window.addEventListener("beforeunload", (event) => {
      if (!this.saved || this.box.value.trim()) event.preventDefault();
    });
  }

  readonly saveButton = button("Save copy", () => this.save(), { id: "save-copy", title: "Save this page with the notes in it" });
  readonly here = button("Note here", () => this.box.focus(), { id: "note-here", title: "Write a note on this sample" });

  private where(): void {
    const { sample } = this.app;
    this.place.textContent = sample ? `at ${this.face(sample.face)}, sample ${sample.row}` : "on the whole: no sample is selected";
  }

  private face(number: number): string {
    return this.app.meta.faces.find((each) => each.number === number)?.id ?? `F${number}`;
  }

  private add(): void {
    const text = this.box.value.trim();
    if (!text) {
      this.app.say("The note is empty");
      this.box.focus();
      return;
    }
    const { sample, cutter } = this.app;
    this.notes.push({ text, face: sample && this.face(sample.face), sample: sample && sample.row, cutter: sample && cutter.id });
    this.box.value = "";
    this.changed(`Note ${this.notes.length} added: Save copy keeps it`);
  }

  private remove(at: number): void {
    this.notes.splice(at, 1);
    this.changed(`Note ${at + 1} removed`);
    this.box.focus();
  }

  private changed(said: string): void {
    this.saved = false;
    this.show();
    this.app.say(said);
  }

  private show(): void {
    this.list.replaceChildren(
      ...this.notes.map((note, k) =>
        el(
          "li",
          {},
          note.sample === null ? null : button(this.about(note), () => this.go(note), { class: "text place" }),
          el("span", { class: "said" }, note.text),
          button("Remove", () => this.remove(k), { class: "copy", "aria-label": `Remove note ${k + 1}` }),
        ),
      ),
    );
    this.saveButton.classList.toggle("unsaved", !this.saved);
  }

  private go({ sample, cutter }: Note): void {
    const { app } = this;
    // A copy is of one plan; still, a note that was edited by hand must not end the page.
    if (sample === null || !(sample >= 0 && sample < app.samples.count)) return app.say("The sample of this note is not in the plan");
    if (cutter && cutter !== app.cutter.id && app.meta.cutters.some((each) => each.id === cutter)) app.setCutter(cutter);
    app.select(sample);
    flyTo(app, app.samples.point(sample) as Vec, app.samples.normal(sample));
  }

  private about({ face, sample, cutter }: Note): string {
    const found = this.app.meta.cutters.find((each) => each.id === cutter);
    return `${face ?? "?"}, sample ${sample}${found ? `, ${found.name || found.id}` : ""}`;
  }

  /** The page as it was loaded, with the notes in it as data and as a list that is read without scripts, too. */
  copy(): string {
    const page = this.pristine.cloneNode(true) as HTMLElement;
    const data = page.querySelector(`#${DATA}`);
    if (!data) throw new Error("the page has no place for notes");
    data.textContent = JSON.stringify(this.notes).replace(/[<>&\u2028\u2029]/g, (sign) => ESCAPED[sign]);
    const items = this.notes.map((note) => el("li", {}, note.sample === null ? "" : `${this.about(note)}: `, note.text));
    page.querySelector(`#${SECTION}`)?.replaceChildren(...(items.length ? [el("h2", {}, "Review notes"), el("ol", {}, ...items)] : []));
    return `<!doctype html>\n${page.outerHTML}\n`;
  }

  private save(): void {
    if (this.box.value.trim()) this.add();
    const link = el("a", { href: URL.createObjectURL(new Blob([this.copy()], { type: "text/html" })), download: copyName(location.pathname) });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
    this.saved = true;
    this.show();
    this.app.say(`Saved as ${link.download}, where this browser keeps downloads`);
  }
}

/** A name that does not take the place of the page itself: the next plan writes over that. */
export function copyName(path: string): string {
  let name = path.split("/").pop() ?? "";
  try {
    name = decodeURIComponent(name);
  } catch {
    // A name with a stray percent sign stays as it is.
  }
  return `${name.replace(/\.html?$/i, "").replace(/-notes$/, "") || "review"}-notes.html`;
}

/** Notes of a saved copy; what is no note is left out. */
function read(): Note[] {
  const found: unknown = JSON.parse(document.getElementById(DATA)?.textContent || "[]");
  const texts = (Array.isArray(found) ? found : []).filter((each) => typeof each?.text === "string");
  return texts.map(({ text, face, sample, cutter }) => ({
    text,
    face: typeof face === "string" ? face : null,
    sample: Number.isInteger(sample) ? sample : null,
    cutter: typeof cutter === "string" ? cutter : null,
  }));
}

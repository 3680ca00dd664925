// What a reviewer writes: notes, each at a sample or of the whole, open or done, and whether the plan is approved, each with a name and
// a date; all of it is kept in the copy of the page that is saved.

import { button, el } from "./dom.ts";
import type { Vec } from "./meta.ts";
import type { Picture } from "./picture.ts";
import { flyTo } from "./views.ts";

export interface Note {
  text: string;
  face: string | null;
  sample: number | null;
  cutter: string | null;
  /** Who wrote it, and when; empty in copies of older pages. */
  name: string;
  date: string;
  done: boolean;
}

export const STATES = { approved: "Approved", rejected: "Rejected" } as const;

export interface Decision {
  state: keyof typeof STATES;
  name: string;
  date: string;
}

export interface Review {
  notes: Note[];
  decision: Decision | null;
}

/** Scripts of a page must not end where a note says so. */
const ESCAPED: Record<string, string> = { "<": "\\u003c", ">": "\\u003e", "&": "\\u0026", "\u2028": "\\u2028", "\u2029": "\\u2029" };

/** The text of a review, as it stands within a page. */
export function written(review: Review): string {
  return JSON.stringify(review).replace(/[<>&\u2028\u2029]/g, (sign) => ESCAPED[sign]);
}

/** The review in a saved copy; older copies have notes alone. What is no note, or no decision, is left out; null: it is no JSON. */
export function read(text: string): Review | null {
  let found: unknown;
  try {
    found = JSON.parse(text || "[]");
  } catch {
    return null;
  }
  const { notes, decision } = (Array.isArray(found) ? { notes: found } : (found ?? {})) as { notes?: unknown; decision?: Partial<Decision> };
  const kept = (Array.isArray(notes) ? notes : []).filter((each) => typeof each?.text === "string");
  return {
    notes: kept.map(({ text, face, sample, cutter, name, date, done }) => ({
      text,
      face: worded(face) || null,
      sample: Number.isInteger(sample) ? sample : null,
      cutter: worded(cutter) || null,
      name: worded(name),
      date: worded(date),
      done: done === true,
    })),
    // A decision that nobody made is none.
    decision: typeof decision?.state === "string" && Object.hasOwn(STATES, decision.state) && worded(decision.name)
      ? { state: decision.state, name: worded(decision.name), date: worded(decision.date) }
      : null,
  };
}

const worded = (value: unknown): string => (typeof value === "string" ? value : "");

/** Who and when, as far as they are known. */
export const signed = ({ name, date }: { name: string; date: string }): string => [name, date].filter(Boolean).join(", ");

/** A moment in local time, such as 2026-11-27 18:40. */
export function moment(date: Date): string {
  const two = (number: number): string => String(number).padStart(2, "0");
  return `${date.getFullYear()}-${two(date.getMonth() + 1)}-${two(date.getDate())} ${two(date.getHours())}:${two(date.getMinutes())}`;
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

type Place = Pick<Note, "face" | "sample" | "cutter">;

const SECTION = "review-notes";
const DATA = "notes-data";
/** Where the first line of the page says what was decided. */
const DECISION = "decision";

export class Notes {
  private readonly stored = read(document.getElementById(DATA)?.textContent ?? "");
  private readonly review: Review = this.stored ?? { notes: [], decision: null };
  /** Where the note that is being written was begun: it stays there, whatever is selected meanwhile. */
  private begun: Place | null = null;
  private saved = true;
  private readonly list = el("ol", { class: "notes" });
  private readonly box = el("textarea", { id: "note", rows: 2, "aria-describedby": "note-place" });
  private readonly place = el("span", { id: "note-place", class: "hint" });
  private readonly name = el("input", { id: "reviewer", type: "text", autocomplete: "name", placeholder: "Your name" });
  private readonly made = el("span", { id: "made-decision" });
  private readonly withdraw = button("Withdraw", () => this.decide(null), { id: "withdraw" });

  /** `pristine` is the page as it was loaded, before anything in it came alive. */
  constructor(private readonly picture: Picture, private readonly pristine: HTMLElement) {
    const section = document.getElementById(SECTION);
    const parts = [
      el("h2", {}, "Review"),
      el("p", { class: "hint" }, "Notes and the decision are kept in the copy that ", el("strong", {}, "Save copy"), " writes, and nowhere else."),
      this.stored ? null : el("p", { class: "wrong" }, "The notes in this file cannot be read, and a copy of it would not have them."),
      el("p", {}, this.made, " ", this.withdraw),
      this.list,
      el("label", { for: "note" }, "New note"),
      this.box,
      el("p", { class: "tools" }, button("Add note", () => this.add(), { id: "add-note" }), this.place),
    ];
    section?.replaceChildren(...parts.filter((part) => part !== null));
    this.box.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) this.add();
    });
    this.box.addEventListener("input", () => {
      this.begun = this.box.value.trim() ? (this.begun ?? this.current()) : null;
      this.where();
    });
    this.name.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && this.wanted) this.decide(this.wanted);
    });
    picture.state.on("sample", () => this.where());
    this.where();
    this.show();
    window.addEventListener("beforeunload", (event) => {
      if (!this.saved || this.box.value.trim()) event.preventDefault();
    });
  }

  /** What stands at the top of the page: the decision, a note, the copy; and whose they are, which is asked for where it is needed. */
  readonly buttons = (): HTMLElement[] => [
    this.asked,
    button("Approve", () => this.decide("approved"), { id: "approve" }),
    button("Reject", () => this.decide("rejected"), { id: "reject" }),
    button("Note", () => this.moveHere(), { id: "to-note", title: "Write a note on the sample shown, or on the whole" }),
    this.saveButton,
  ];

  private readonly asked = el("span", { id: "asked", hidden: true }, el("label", { for: "reviewer" }, "Your name"), this.name);
  /** What is decided once the name is there. */
  private wanted: Decision["state"] | null = null;

  readonly saveButton = button("Save copy", () => this.save(), { id: "save-copy", title: "Save this page with the notes and the decision in it" });
  readonly here = button("Note here", () => this.moveHere(), { id: "note-here", title: "Write a note on this sample" });

  private current(): Place {
    const { sample, cutter } = this.picture.state;
    return { face: sample && this.face(sample.face), sample: sample && sample.row, cutter: sample && cutter.id };
  }

  /** Who asks for it writes on the sample that is shown now. */
  private moveHere(): void {
    if (this.begun) this.begun = this.current();
    this.asked.hidden = false;
    this.where();
    this.box.scrollIntoView({ block: "center" });
    this.box.focus();
  }

  private where(): void {
    const { face, sample } = this.begun ?? this.current();
    this.place.textContent = sample === null ? "on the whole: no sample is selected" : `at ${face}, sample ${sample}`;
  }

  private face(number: number): string {
    return this.picture.state.meta.faces.find((each) => each.number === number)?.id ?? `F${number}`;
  }

  private stamp(): { name: string; date: string } {
    return { name: this.name.value.trim(), date: moment(new Date()) };
  }

  private decide(state: Decision["state"] | null): void {
    const stamp = this.stamp();
    if (state && !stamp.name) {
      this.picture.state.say("Write your name first: a decision needs one. Enter takes it.");
      this.wanted = state;
      this.asked.hidden = false;
      this.name.focus();
      return;
    }
    this.wanted = null;
    this.review.decision = state && { state, ...stamp };
    const open = this.review.notes.filter(({ done }) => !done).length;
    const still = state === "approved" && open ? ` ${open === 1 ? "1 note is" : `${open} notes are`} still open.` : "";
    this.changed(state ? `${STATES[state]} by ${signed(stamp)}: Save copy keeps it.${still}` : "The decision is withdrawn");
  }

  private add(): void {
    const text = this.box.value.trim();
    if (!text) {
      this.picture.state.say("The note is empty");
      this.box.focus();
      return;
    }
    this.review.notes.push({ text, ...(this.begun ?? this.current()), ...this.stamp(), done: false });
    this.box.value = "";
    this.begun = null;
    this.where();
    this.changed(`Note ${this.review.notes.length} added: Save copy keeps it`);
  }

  private remove(at: number): void {
    this.review.notes.splice(at, 1);
    this.changed(`Note ${at + 1} removed`);
    this.box.focus();
  }

  private finish(note: Note, at: number): void {
    note.done = !note.done;
    this.changed(`Note ${at + 1} is ${note.done ? "done" : "open"}`);
    this.list.children[at].querySelector("input")?.focus();
  }

  private changed(words: string): void {
    this.saved = false;
    this.show();
    this.picture.state.say(words);
  }

  private show(): void {
    const { notes, decision } = this.review;
    this.list.replaceChildren(
      ...notes.map((note, k) => {
        const box = el("input", { type: "checkbox", checked: note.done, "aria-label": `Note ${k + 1} is done` });
        box.addEventListener("change", () => this.finish(note, k));
        return el(
          "li",
          { class: note.done ? "done" : "open" },
          note.sample === null ? null : button(this.about(note), () => this.go(note), { class: "text place" }),
          el("span", { class: "said" }, note.text),
          el("span", { class: "signed" }, [signed(note), note.done ? "done" : "open"].filter(Boolean).join("; ")),
          el("label", { class: "check" }, box, "done"),
          button("Remove", () => this.remove(k), { class: "copy", "aria-label": `Remove note ${k + 1}` }),
        );
      }),
    );
    tell(document.documentElement, decision);
    this.made.textContent = decision ? sentence(decision) : "Nobody has decided on this plan yet.";
    this.withdraw.hidden = !decision;
    this.saveButton.classList.toggle("unsaved", !this.saved);
  }

  private go({ sample, cutter }: Note): void {
    const { picture, picture: { state } } = this;
    // A copy is of one plan; still, a note that was edited by hand must not end the page.
    if (sample === null || !(sample >= 0 && sample < state.samples.count)) return state.say("The sample of this note is not in the plan");
    if (cutter && cutter !== state.cutter.id && state.meta.cutters.some((each) => each.id === cutter)) state.setCutter(cutter);
    state.select(sample);
    flyTo(picture, state.samples.point(sample) as Vec, state.samples.normal(sample));
  }

  private about({ face, sample, cutter }: Note): string {
    const shown = this.picture.state.meta.cutters.find((each) => each.id === cutter);
    return `${face ?? "?"}, sample ${sample}${shown ? `, ${shown.name || shown.id}` : ""}`;
  }

  /** The page as it was loaded, with the review in it as data and as a list that is read without scripts, too. */
  copy(): string {
    const page = this.pristine.cloneNode(true) as HTMLElement;
    const data = page.querySelector(`#${DATA}`);
    if (!data) throw new Error("the page has no place for notes");
    const { notes, decision } = this.review;
    data.textContent = written(this.review);
    tell(page, decision);
    const items = notes.map((note) => {
      const state = [signed(note), note.done ? "done" : "open"].filter(Boolean).join("; ");
      return el("li", {}, note.sample === null ? "" : `${this.about(note)}: `, note.text, ` (${state})`);
    });
    const made = decision ? [el("p", {}, sentence(decision))] : [];
    const list = items.length ? [el("ol", {}, ...items)] : [];
    page.querySelector(`#${SECTION}`)?.replaceChildren(...(made.length + list.length ? [el("h2", {}, "Review"), ...made, ...list] : []));
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
    this.picture.state.say(`Saved as ${link.download}, where this browser keeps downloads`);
  }
}

const sentence = (decision: Decision): string => `${STATES[decision.state]} by ${signed(decision)}.`;

/** Say in the first line of a page what was decided. */
function tell(page: HTMLElement, decision: Decision | null): void {
  const place = page.querySelector<HTMLElement>(`#${DECISION}`);
  if (!place) return;
  place.hidden = !decision;
  place.className = `chip ${decision?.state === "approved" ? "good" : "bad"}`;
  place.textContent = decision ? `${STATES[decision.state]} by ${signed(decision)}` : "";
}

// What a reviewer leaves in a page: notes with their state, and a decision on the plan, each with a name and a date.

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

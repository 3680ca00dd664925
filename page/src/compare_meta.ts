// The form of the data of two plans, as plan_cutters_ci.review writes it.

import { text } from "./decode.ts";
import type { Meta, Pattern } from "./meta.ts";

export const WORDS = ["old", "new"] as const;
export type Word = (typeof WORDS)[number];

export interface Mark {
  label: string;
  colour: string;
  pattern: Pattern;
}

export interface Pair {
  name: string;
  /** Ids; null: it is not among the cutters of that plan. */
  old: string | null;
  new: string | null;
}

export interface Told {
  /** What can become of a face, in the order of the legend. */
  marks: Record<string, Mark>;
  /** What became of each face: a word of `marks` by its id. */
  states: Record<Word, Record<string, string>>;
  /** Ids of the faces that were known again, old and new. */
  pairs: [string, string][];
  cutters: Pair[];
  /** Null: there is no picture of that plan. */
  old: Meta | null;
  new: Meta | null;
}

export function readTold(): Told {
  const told = JSON.parse(text("meta")) as Told;
  for (const word of WORDS) {
    const format = told[word]?.format ?? 1;
    if (format !== 1) throw new Error(`the data have format ${format}, this page reads 1`);
  }
  return told;
}

// What both parts are coloured by: what became of each face, or the verdicts of one cutter or of all.

import { colourOf, type Entry, type Look, lookOf, painted, PATTERNS, patternOf, rgb, spoken } from "./colours.ts";
import type { Arrays } from "./decode.ts";
import type { Told, Word } from "./compare_meta.ts";
import type { Meta } from "./meta.ts";
import type { Samples } from "./samples.ts";

/** What is shown of one plan. */
export interface Shown {
  word: Word;
  meta: Meta;
  arrays: Arrays;
  samples: Samples;
}

/** From worst to best: a sample is shown as the best cutter reaches it. */
const RANK = ["unjudged", "inaccessible", "undecided", "accessible", "interference_free"];
const ABSENT: Entry = { colour: "#9a9a9a", pattern: "back", label: "not among the cutters of this plan" };

/** A colour for each face, by its place in `meta.faces`. */
export function facesLook(told: Told, { word, meta }: Shown): Look {
  const words = Object.keys(told.marks);
  const state = meta.faces.map(({ id }) => words.indexOf(told.states[word][id] ?? "not asked"));
  const bytes = new Uint8Array(4 * meta.faces.length);
  const marks = Object.values(told.marks);
  const table = marks.map((each) => [...rgb(each.colour), PATTERNS.indexOf(each.pattern)]);
  state.forEach((k, i) => bytes.set(table[k], 4 * i));
  const count = marks.map((_, k) => state.filter((each) => each === k).length);
  return { title: "Faces", entries: marks.map((each, k) => ({ ...each, share: count[k] })).filter((each) => each.share), ramp: null, bytes };
}

/** A colour for each sample: verdicts of a cutter, or the best ones of all where `pair` is null. */
export function verdictLook(told: Told, side: Shown, number: number | null): Look {
  const { word, meta, arrays, samples } = side;
  if (number !== null) {
    const id = told.cutters[number]?.[word] ?? null;
    return id === null ? painted(meta, "", [ABSENT], samples, () => 0) : lookOf(meta, arrays, samples, "verdict", id);
  }
  const entries = [...RANK, "inside_bodies", "drilled"].map((each) => ({
    colour: colourOf(meta, each),
    pattern: patternOf(each),
    label: spoken(meta, each),
  }));
  const best = new Uint8Array(samples.count);
  for (const { id } of meta.cutters) {
    const { values } = samples.verdicts(id);
    const rank = Array.from({ length: 256 }, (_, code) => Math.max(0, RANK.indexOf(meta.verdicts[String(code)] ?? "")));
    for (let i = 0; i < best.length; i++) best[i] = Math.max(best[i], rank[values[i]]);
  }
  const drilled = (i: number): boolean => samples.verdict(meta.cutters[0].id, i) === "drilled";
  return painted(meta, "", entries, samples, (i) => (samples.inside(i) ? RANK.length : drilled(i) ? RANK.length + 1 : best[i]));
}

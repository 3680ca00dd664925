// What the surface is coloured by: a colour and a pattern for each sample, and the legend that says so.

import type { Arrays } from "./decode.ts";
import type { Meta, OperationPlan, Pattern, Process, Scalar } from "./meta.ts";
import { NO_REASON } from "./meta.ts";
import { modeOf, othersOf, planOf, PROCESS, stepOf, takenBy, titleOf } from "./plans.ts";
import type { Samples } from "./samples.ts";

export const PATTERNS: Pattern[] = ["plain", "hatch", "dots", "cross", "bars", "lines", "back"];

export interface Entry {
  colour: string;
  pattern: Pattern;
  label: string;
  /** Share of the area that samples stand for, 0 to 1. */
  share?: number;
}

export interface Ramp {
  low: number;
  high: number;
  unit: string;
  /** Whether samples lie beyond the ends. */
  below: boolean;
  above: boolean;
}

export interface Look {
  title: string;
  entries: Entry[];
  ramp: Ramp | null;
  /** Red, green, blue and pattern of each sample. */
  bytes: Uint8Array;
}

export interface Mode {
  key: string;
  label: string;
}

const capital = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);

const UNKNOWN = "#9a9a9a";

/** A word of the plan as it is shown. */
export const spoken = (meta: Meta, word: string): string => (meta.words[word] ?? meta.causes[word])?.name ?? word;

/** Where the drawn triangles meet nothing, which is no proof: paler than what is certified to be free. */
export const OPEN: [string, Pattern] = ["#9ddcc6", "plain"];

/** Colour and pattern of what forbids a posture, or of what is free of it. */
export function causeOf(meta: Meta, cause: string): [string, Pattern] {
  const found = meta.causes[cause];
  return found ? [found.colour, found.pattern] : [colourOf(meta, cause === "free" ? "interference_free" : cause), patternOf(cause)];
}

const CLASSES: [string, string, Pattern][] = [
  ["convex", "#E8B04A", "plain"],
  ["concave", "#2F6DB0", "plain"],
  ["saddle", "#7FC8A9", "plain"],
];

export function modesOf(meta: Meta): Mode[] {
  return [
    ...(meta.process ? [{ key: PROCESS, label: "Step" }] : []),
    { key: "verdict", label: "Verdict" },
    ...othersOf(meta).map((plan) => ({ key: modeOf(meta, plan), label: titleOf(plan) })),
    { key: "reason", label: "Reason" },
    ...(meta.setups.length ? [{ key: "setup", label: "Setup that serves" }] : []),
    { key: "class", label: "Surface class" },
    ...meta.scalars.map((each) => ({ key: `scalar:${each.key}`, label: capital(each.label) })),
  ];
}

export function lookOf(meta: Meta, arrays: Arrays, samples: Samples, mode: string, cutter: string): Look {
  const scalar = meta.scalars.find((each) => `scalar:${each.key}` === mode);
  if (scalar) return scalarLook(arrays, samples, scalar);
  if (mode === "reason") return reasonLook(meta, samples, cutter);
  if (mode === "setup") return setupLook(meta, samples, cutter);
  if (mode === "class") return classLook(meta, samples);
  if (mode === PROCESS && meta.process) return processLook(meta, arrays, samples, meta.process, cutter);
  const plan = planOf(meta, mode);
  return plan ? operationLook(meta, arrays, samples, plan, cutter) : verdictLook(meta, samples, cutter);
}

export const colourOf = (meta: Meta, word: string): string => meta.words[word]?.colour ?? UNKNOWN;

export function patternOf(verdict: string): Pattern {
  return verdict === "inaccessible" ? "hatch" : verdict === "undecided" ? "dots" : "plain";
}

const plain = (meta: Meta, word: string): Entry => ({ colour: colourOf(meta, word), pattern: "plain", label: spoken(meta, word) });

/** What no cutter has to reach: nobody judged it, it waits for a drill, or lies within a body. */
const OTHERS = ["unjudged", "drilled", "inside_bodies"];
const otherEntries = (meta: Meta): Entry[] => OTHERS.map((word) => plain(meta, word));

const VERDICTS = ["interference_free", "accessible", "undecided", "inaccessible", "unjudged", "drilled", "inside_bodies"];

const verdictEntries = (meta: Meta): Entry[] =>
  VERDICTS.map((word) => ({ colour: colourOf(meta, word), pattern: patternOf(word), label: spoken(meta, word) }));

function verdictLook(meta: Meta, samples: Samples, cutter: string): Look {
  return painted(meta, "Verdict", verdictEntries(meta), samples, (i) => VERDICTS.indexOf(samples.verdict(cutter, i)));
}

/** What stays of the process: pale and hatched, so that it is no colour of a step. */
export const STAYS: Omit<Entry, "share"> = { colour: "#c4c9ce", pattern: "hatch", label: "stays" };

/** Holes that wait for a drill: no colour of a step, too. */
const DRILLED: Entry = { colour: "#b9a3d6", pattern: "dots", label: "for drills" };

/** Which step finishes each sample, with the shares of the plan; the rest is hatched, but for what no cutter has to reach. */
function processLook(meta: Meta, arrays: Arrays, samples: Samples, process: Process, cutter: string): Look {
  const { steps } = process;
  const number = stepOf(arrays);
  const others = OTHERS.map((word) => (word === "drilled" ? DRILLED : plain(meta, word)));
  const entries: Entry[] = [...steps.map(({ colour, pattern, label }) => ({ colour, pattern, label })), STAYS, ...others];
  const look = painted(meta, "Process, by step", entries, samples, (i) => {
    const k = number(i);
    return k ? k - 1 : steps.length + 1 + OTHERS.indexOf(samples.verdict(cutter, i));
  });
  const share = (label: string): number | undefined => (label === STAYS.label ? process.left_share : steps.find((each) => each.label === label)?.share);
  return { ...look, entries: look.entries.map((each) => ({ ...each, share: share(each.label) ?? each.share ?? 0 })) };
}

/** Which operation takes each sample; what none takes keeps the colours of its verdicts. */
function operationLook(meta: Meta, arrays: Arrays, samples: Samples, plan: OperationPlan, cutter: string): Look {
  const { operations } = plan;
  const number = takenBy(plan, arrays);
  return painted(meta, titleOf(plan), [...operations, ...verdictEntries(meta)], samples, (i) => {
    const k = number(i);
    return k >= 0 ? k : operations.length + VERDICTS.indexOf(samples.verdict(cutter, i));
  });
}

function reasonLook(meta: Meta, samples: Samples, cutter: string): Look {
  const verdict = samples.verdicts(cutter).values;
  const reason = samples.reasons(cutter).values;
  const entries = meta.reasons.map((word): Entry => ({ colour: causeOf(meta, word)[0], pattern: "hatch", label: spoken(meta, word) }));
  const undecided = entries.map((each): Entry => ({ ...each, pattern: "dots", label: `${each.label}, undecided` }));
  const reached: Entry = { colour: "#d9e4dd", pattern: "plain", label: "reached" };
  const count = entries.length;
  return painted(meta, "Reason", [...entries, ...undecided, reached, ...otherEntries(meta)], samples, (i) => {
    const other = OTHERS.indexOf(samples.verdict(cutter, i));
    if (other >= 0) return 2 * count + 1 + other;
    if (reason[i] === NO_REASON) return 2 * count;
    return reason[i] + (meta.verdicts[String(verdict[i])] === "undecided" ? count : 0);
  });
}

/** Which setup serves each sample: a colour of the scale for each. */
function setupLook(meta: Meta, samples: Samples, cutter: string): Look {
  const count = meta.setups.length;
  const entries = meta.setups.map(({ z }, k): Entry => {
    const label = `setup ${k + 1}: ${z.map((x) => Number(x.toFixed(4))).join(", ")}`;
    return { colour: ramp(count > 1 ? k / (count - 1) : 0), pattern: "plain", label };
  });
  const none: Entry = { colour: colourOf(meta, "inaccessible"), pattern: "hatch", label: "no setup" };
  return painted(meta, "Setup that serves", [...entries, none, ...otherEntries(meta)], samples, (i) => {
    const other = OTHERS.indexOf(samples.verdict(cutter, i));
    return other >= 0 ? count + 1 + other : (samples.setup(cutter, i) ?? count);
  });
}

function classLook(meta: Meta, samples: Samples): Look {
  const kind = samples.surfaceClass.values;
  const entries: Entry[] = CLASSES.map(([label, colour, pattern]) => ({ label, colour, pattern }));
  entries.push(plain(meta, "unjudged"));
  return painted(meta, "Surface class", entries, samples, (i) => Math.min(kind[i], 3));
}

export function painted(meta: Meta, title: string, entries: Entry[], samples: Samples, which: (i: number) => number): Look {
  const { count } = samples;
  const bytes = new Uint8Array(4 * count);
  const table = entries.map((each) => [...rgb(each.colour), PATTERNS.indexOf(each.pattern)]);
  const area = new Float64Array(entries.length);
  const seen = new Uint8Array(entries.length);
  for (let i = 0; i < count; i++) {
    const k = which(i);
    seen[k] = 1;
    area[k] += samples.area(i);
    bytes.set(table[k], 4 * i);
  }
  const whole = area.reduce((sum, each) => sum + each, 0);
  // What is no surface of the finished part is a share of all; the others are shares of what is left.
  const inside = entries.findIndex((each) => each.label === spoken(meta, "inside_bodies"));
  const left = whole - (area[inside] ?? 0);
  const others = seen.filter((there, k) => there && k !== inside).length;
  // Samples may stand for no area, and sums are rounded: only what is alone is all.
  const exact = (share: number, all: boolean): number => (all ? 1 : Math.min(Math.max(share, Number.MIN_VALUE), 1 - Number.EPSILON));
  const shown = entries.map((each, k) => ({
    ...each,
    share: k === inside ? exact(area[k] / (whole || 1), !others) : exact(area[k] / (left || 1), others === 1),
  }));
  return { title, entries: shown.filter((_, k) => seen[k]), ramp: null, bytes };
}

function scalarLook(arrays: Arrays, samples: Samples, scalar: Scalar): Look {
  const table = arrays.get(scalar.array);
  const first = (scalar.column ?? 0) * table.rows;
  const values = table.values.subarray(first, first + table.rows);
  const [low, high] = ends(values);
  const bytes = new Uint8Array(4 * samples.count);
  const steps = Array.from({ length: 256 }, (_, i) => rgb(ramp(i / 255)));
  const unknown = rgb(UNKNOWN);
  const range = high - low || 1;
  let [below, above, missing] = [false, false, 0];
  let whole = 0;
  for (let i = 0; i < samples.count; i++) {
    whole += samples.area(i);
    const value = values[i];
    if (Number.isNaN(value)) {
      missing += samples.area(i);
      bytes.set(unknown, 4 * i);
      bytes[4 * i + 3] = PATTERNS.indexOf("cross");
      continue;
    }
    const share = (value - low) / range;
    below ||= share < -1e-3;
    above ||= share > 1.001;
    bytes.set(steps[Math.round(255 * Math.min(1, Math.max(0, share)))], 4 * i);
  }
  const entries: Entry[] = missing
    ? [{ colour: UNKNOWN, pattern: "cross", label: "not known", share: missing / (whole || 1) }]
    : [];
  return { title: capital(scalar.label), entries, ramp: { low, high, unit: scalar.unit, below, above }, bytes };
}

/** Ends of the scale: but for one hundredth at either end, where single samples of sharp edges would take all of it. */
function ends(values: ArrayLike<number>): [number, number] {
  const known = Float32Array.from(values).filter(Number.isFinite).sort();
  if (!known.length) return [0, 1];
  const at = (share: number): number => known[Math.round(share * (known.length - 1))];
  return [at(0.01), at(0.99)];
}

/** A colour of the scale, 0 to 1: even steps of lightness in OKLab from dark blue to light yellow, told apart by any eye. */
export function ramp(share: number): string {
  const light = 0.38 + 0.54 * share;
  const hue = ((275 - 170 * share) * Math.PI) / 180;
  const chroma = 0.105 + 0.02 * share;
  return oklab(light, chroma * Math.cos(hue), chroma * Math.sin(hue));
}

function oklab(light: number, a: number, b: number): string {
  const l = (light + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (light - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (light - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const linear = [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
  const bytes = linear.map((x) => {
    const c = Math.min(1, Math.max(0, x));
    return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
  });
  return `#${bytes.map((x) => x.toString(16).padStart(2, "0")).join("")}`;
}

export function rgb(hex: string): [number, number, number] {
  const value = Number.parseInt(hex.slice(1), 16);
  return [(value >> 16) & 255, (value >> 8) & 255, value & 255];
}

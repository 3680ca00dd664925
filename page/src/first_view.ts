// The first view shows what is lost: the side from which most of the area that is not reached is seen.

import type { App } from "./app.ts";
import type { Vec } from "./meta.ts";
import { dot } from "./vectors.ts";

/** Samples that are looked at: enough to tell one side from another. */
const LOOKED = 300;
/** Another side is shown only where it shows so many times more than the usual one. */
const WORTH = 1.3;

export function firstView(app: App): void {
  const { samples, cutter, picker } = app;
  const { table } = app.stage;
  const lost: number[] = [];
  for (let row = 0; row < samples.count; row++) {
    const verdict = samples.verdict(cutter.id, row);
    if (verdict === "inaccessible" || verdict === "undecided") lost.push(row);
  }
  if (!lost.length) return;
  const step = Math.max(1, Math.floor(lost.length / LOOKED));
  const looked = lost.filter((_, i) => i % step === 0).map((row) => ({ area: samples.area(row), point: samples.point(row), normal: samples.normal(row) }));
  const back = (turn: number, rise: number): Vec => table.frame({ ...table.aim, turn, rise }).back;
  // Facing counts, for what is seen from the side is hardly seen.
  const facing = (way: Vec): number => looked.reduce((sum, { area, normal }) => sum + area * Math.max(0, dot(way, normal)), 0);
  const seen = (way: Vec): number =>
    looked.reduce((sum, { area, point, normal }) => {
      const front = dot(way, normal);
      return front > 0.1 && !picker.hidden(point, way) ? sum + area * front : sum;
    }, 0);
  const usual = table.aim;
  const views = [32, -32, 75].flatMap((rise) => Array.from({ length: 8 }, (_, k) => ({ turn: usual.turn + 45 * k, rise })));
  // Rays cost: only the sides that face most of it are looked at.
  const near = views.map((view) => ({ view, front: facing(back(view.turn, view.rise)) })).sort((a, b) => b.front - a.front);
  let best = WORTH * seen(back(usual.turn, usual.rise));
  let found: { turn: number; rise: number } | null = null;
  for (const { view, front } of near.slice(0, 6)) {
    if (front <= best) continue;
    const much = seen(back(view.turn, view.rise));
    if (much > best) [best, found] = [much, view];
  }
  if (found) table.show(found.turn, found.rise);
}

// The first view is from the spindle's side, with the part as large as it can be seen there; what holds it is seen through. Other
// views show what stays: from the sides from which most of its faces are seen, and of these most of the area.

import type { App } from "./app.ts";
import type { View } from "./camera.ts";
import type { Owner } from "./mesh.ts";
import type { Vec } from "./meta.ts";
import { PROCESS, stepOf } from "./operations.ts";
import { dot } from "./vectors.ts";

/** Samples that are looked at, about, and of each face at least: enough to tell one side from another. */
const [LOOKED, OF_FACE] = [160, 3];
/** Another side is shown only where it shows more faces, or so many times more of the area than the usual one. */
const WORTH = 1.3;
/** Less is hardly seen: the cosine between the normal and the way to the eye. */
const FACING = 0.17;
/** A fixture is faded where it hides more than this share of what is seen of what is lost, or all of a face. */
const MUCH = 0.1;
/** Directions that are looked along, the usual one aside. */
const MOST = 10;

/** Verdicts of what a cutter loses, and of what can stay of a process: another cutter may reach it, and no step take it. */
const LOST = new Set(["inaccessible", "undecided"]);
const STAYS = new Set([...LOST, "accessible", "interference_free"]);

interface Looked {
  face: Owner;
  area: number;
  point: Vec;
  normal: Vec;
}

/** What is seen from a side. */
interface Seen extends View {
  faces: Set<Owner>;
  area: number;
  /** By fixture, what it hides of that. */
  behind: Map<Owner, number>;
  /** Faces of which nothing is seen without a fixture before it. */
  covered: Map<Owner, Set<Owner>>;
}

/** Heights over the plane across the spindle from which the part is looked at first, degrees; another turn must show so much more. */
const [RISES, MORE] = [[34, 48, 60], 1.08];
/** Vertices that are looked at, about. */
const VERTICES = 3000;

/** Look at the part from the spindle's side, from where it fills most of the picture; all that holds it is seen through. */
export function firstView(app: App): void {
  const { drawn, eyes, stage: { table } } = app;
  eyes?.fade(new Set(app.meta.fixtures.map((_, i) => -1 - i)));
  const all = drawn.shownVertices;
  const step = 3 * Math.max(1, Math.floor(all.length / 3 / VERTICES));
  const points = Array.from({ length: Math.ceil(all.length / step) }, (_, i) => [...all.subarray(i * step, i * step + 3)] as Vec);
  const { turn } = table.aim;
  let best = { turn, rise: RISES[0], fills: 0 };
  for (let k = 0; k < 12 && points.length > 2; k++) {
    for (const rise of RISES) {
      const aim = table.fitted(turn + 30 * k, rise);
      const { right, up } = table.frame(aim);
      const fills = hullArea(points.map((point) => [dot(point, right), dot(point, up)])) / (4 * aim.half ** 2 * table.aspect);
      if (fills > MORE * best.fills) best = { turn: turn + 30 * k, rise, fills };
    }
  }
  table.show(best.turn, best.rise);
}

/** The area of the convex hull of points in a plane, by Andrew's chain. */
function hullArea(points: [number, number][]): number {
  points.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (way: [number, number][]): number => {
    const chain: [number, number][] = [];
    for (const p of way) {
      while (chain.length > 1) {
        const [a, b] = chain.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        chain.pop();
      }
      chain.push(p);
    }
    return chain.slice(1).reduce((sum, p, k) => sum + (chain[k][0] * p[1] - p[0] * chain[k][1]) / 2, 0);
  };
  return half(points) + half(points.reverse());
}

/** The sides that show what stays, the best one first, and so many that no lost face is left that one can see. */
export class LostViews {
  readonly views: Seen[] = [];
  readonly lost: Set<Owner>;
  at = -1;

  constructor(private readonly app: App) {
    const looked = lostSamples(app);
    this.lost = new Set(looked.map(({ face }) => face));
    if (!looked.length) return;
    const usual = app.stage.table.aim;
    const { table } = app.stage;
    const back = (view: View): Vec => table.frame({ ...table.aim, ...view }).back;
    const sides = [32, -32, 72, -72].flatMap((rise) => Array.from({ length: 8 }, (_, k) => ({ turn: usual.turn + 45 * k, rise })));
    // Rays cost: the sides that most of it faces are looked at first, and none that cannot be better.
    const facing = sides.map((view) => {
      const way = back(view);
      const front = looked.filter(({ normal }) => dot(way, normal) > FACING);
      const area = front.reduce((sum, each) => sum + each.area * dot(way, each.normal), 0);
      return { view, way, faces: new Set(front.map(({ face }) => face)), area };
    });
    facing.sort((a, b) => b.faces.size - a.faces.size || b.area - a.area);
    const first = seenFrom(app, looked, usual, back(usual));
    let best = first;
    for (const { view, way, faces, area } of facing.slice(0, MOST)) {
      if (faces.size < best.faces.size || (faces.size === best.faces.size && area <= best.area)) continue;
      const found = seenFrom(app, looked, view, way);
      if (found.faces.size > best.faces.size || (found.faces.size === best.faces.size && found.area > best.area)) best = found;
    }
    if (best.faces.size === first.faces.size && best.area < WORTH * first.area) best = first;
    this.views.push(best);
    // The other sides, each for the most of what is left.
    const left = new Set([...this.lost].filter((face) => !best.faces.has(face)));
    const remaining = [...facing];
    while (left.size && remaining.length) {
      const gain = ({ faces }: { faces: Set<Owner> }): number => [...faces].filter((face) => left.has(face)).length;
      remaining.sort((a, b) => gain(b) - gain(a));
      const next = remaining.shift()!;
      if (!gain(next)) break;
      const found = seenFrom(app, looked.filter(({ face }) => left.has(face)), next.view, next.way);
      if (!found.faces.size) continue;
      this.views.push(found);
      for (const face of found.faces) left.delete(face);
    }
  }

  /** Fly to the next side; which of them. */
  next(): void {
    const { app, views } = this;
    if (!views.length) return app.say("Nothing stays that can be seen");
    this.at = (this.at + 1) % views.length;
    const view = views[this.at];
    app.stage.table.fit(view.turn, view.rise);
    this.said(view);
  }

  private said(view: Seen): void {
    const { app, lost, views } = this;
    const names = app.eyes?.fade(hiding(view)) ?? [];
    const told = names.length ? ` Faded, for it hides some: ${names.join(", ")}.` : "";
    const here = [...lost].filter((face) => view.faces.has(face));
    const many = here.length > 4 ? `${here.length} faces` : here.map((face) => app.drawn.called(face)).join(", ");
    app.say(`What stays, side ${this.at + 1} of ${views.length}: ${many}.${told}`);
  }
}

/** Fixtures that hide much of what would be seen. */
function hiding({ area, behind, covered }: Seen): Set<Owner> {
  const found = new Set([...behind].filter(([, hidden]) => hidden > MUCH * area).map(([owner]) => owner));
  for (const owners of covered.values()) for (const owner of owners) found.add(owner);
  return found;
}

/** Samples of what no step finishes, or the cutter shown loses: some of each face. */
function lostSamples({ arrays, meta, mode, samples, cutter }: App): Looked[] {
  const step = mode === PROCESS ? stepOf(arrays) : null;
  const rows = new Map<number, number[]>();
  let count = 0;
  for (let row = 0; row < samples.count; row++) {
    const verdict = samples.verdict(cutter.id, row);
    if (step ? step(row) > 0 || !STAYS.has(verdict) : !LOST.has(verdict)) continue;
    const face = samples.face.values[row];
    const mine = rows.get(face);
    if (mine) mine.push(row);
    else rows.set(face, [row]);
    count++;
  }
  const owners = new Map(meta.faces.map(({ number }, i) => [number, i]));
  return [...rows].flatMap(([number, mine]) => {
    const wanted = Math.min(mine.length, Math.max(OF_FACE, Math.round((LOOKED * mine.length) / count)));
    const whole = mine.reduce((sum, row) => sum + samples.area(row), 0);
    return Array.from({ length: wanted }, (_, i) => {
      const row = mine[Math.floor(((i + 0.5) * mine.length) / wanted)];
      return { face: owners.get(number) ?? -1, area: whole / wanted, point: samples.point(row), normal: samples.normal(row) };
    });
  });
}

function seenFrom({ picker, drawn }: App, looked: Looked[], view: View, way: Vec): Seen {
  const seen: Seen = { ...view, faces: new Set(), area: 0, behind: new Map(), covered: new Map() };
  const free = new Set<Owner>();
  for (const { face, area, point, normal } of looked) {
    // Facing counts, for what is seen from the side is hardly seen.
    const front = dot(way, normal);
    if (front <= FACING) continue;
    const before = picker.between(point, way);
    if (before.some((owner) => owner >= 0)) continue;
    seen.faces.add(face);
    seen.area += area * front;
    const fixtures = new Set(before.filter((owner) => drawn.seen(owner)));
    for (const owner of fixtures) seen.behind.set(owner, (seen.behind.get(owner) ?? 0) + area * front);
    if (fixtures.size) seen.covered.set(face, new Set([...(seen.covered.get(face) ?? []), ...fixtures]));
    else free.add(face);
  }
  for (const face of free) seen.covered.delete(face);
  return seen;
}

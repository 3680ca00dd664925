// Where to look from: the first view, the sides that show what stays, and views in which a place and the tool there are seen.

import type { Aim, Ring, View } from "./camera.ts";
import type { Owner } from "./mesh.ts";
import type { Vec } from "./meta.ts";
import type { Picture } from "./picture.ts";
import { PROCESS, stepOf } from "./plans.ts";
import type { PageState } from "./state.ts";
import { cross, distance, dot, plus } from "./vectors.ts";

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
export function firstView({ eyes, stage: { table }, state: { drawn, meta } }: Picture): void {
  eyes.fade(new Set(meta.fixtures.map((_, i) => -1 - i)));
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

  constructor(private readonly picture: Picture) {
    const looked = lostSamples(picture.state);
    this.lost = new Set(looked.map(({ face }) => face));
    if (!looked.length) return;
    const { table } = picture.stage;
    const usual = table.aim;
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
    const first = seenFrom(picture, looked, usual, back(usual));
    let best = first;
    for (const { view, way, faces, area } of facing.slice(0, MOST)) {
      if (faces.size < best.faces.size || (faces.size === best.faces.size && area <= best.area)) continue;
      const found = seenFrom(picture, looked, view, way);
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
      const found = seenFrom(picture, looked.filter(({ face }) => left.has(face)), next.view, next.way);
      if (!found.faces.size) continue;
      this.views.push(found);
      for (const face of found.faces) left.delete(face);
    }
  }

  /** Fly to the next side; which of them. */
  next(): void {
    const { picture, views } = this;
    if (!views.length) return picture.state.say("Nothing stays that can be seen");
    this.at = (this.at + 1) % views.length;
    const view = views[this.at];
    picture.stage.table.fit(view.turn, view.rise);
    this.said(view);
  }

  private said(view: Seen): void {
    const { lost, picture: { eyes, state }, views } = this;
    const names = eyes.fade(hiding(view));
    const told = names.length ? ` Faded, for it hides some: ${names.join(", ")}.` : "";
    const here = [...lost].filter((face) => view.faces.has(face));
    const many = here.length > 4 ? `${here.length} faces` : here.map((face) => state.drawn.called(face)).join(", ");
    state.say(`What stays, side ${this.at + 1} of ${views.length}: ${many}.${told}`);
  }
}

/** Fixtures that hide much of what would be seen. */
function hiding({ area, behind, covered }: Seen): Set<Owner> {
  const found = new Set([...behind].filter(([, hidden]) => hidden > MUCH * area).map(([owner]) => owner));
  for (const owners of covered.values()) for (const owner of owners) found.add(owner);
  return found;
}

/** Samples of what no step finishes, or the cutter shown loses: some of each face. */
function lostSamples({ arrays, meta, mode, samples, cutter }: PageState): Looked[] {
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

function seenFrom({ picker, state: { drawn } }: Picture, looked: Looked[], view: View, way: Vec): Seen {
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

/** A tool is seen well from its side: up to this cosine between its axis and the way to the eye nothing is lost. */
const SIDE = 0.5;
/** Of so many views, the best ones first, it is asked whether something hides the place. */
const LOOKED_AT = 80;
/** At a worst spot the part has at least so much of the picture's width or height. */
const PART = 0.5;
/** And the tool not more than so much of the picture, as long as the part has so much of its width or height. */
const [TOOL, LEAST] = [0.4, 0.34];

/** Look at a place of the surface from its outer side, near enough to see what is there. */
export function flyTo(picture: Picture, point: Vec, normal: Vec, size = near(picture.state)): void {
  picture.stage.table.fly({ target: point, half: size, ...openView(picture, [point], normal, null).view });
}

/** Look at a face along the normal of its middle triangle. */
export function showFace(picture: Picture, owner: Owner): void {
  const { drawn, meta, say } = picture.state;
  const place = drawn.middle(owner);
  const face = meta.faces[owner];
  if (!place) return say(`${face.id} is not drawn`);
  const first = drawn.triangle[3 * (face.start + (face.count >> 1))];
  const normal = [0, 1, 2].map((k) => drawn.normal[4 * first + k]) as Vec;
  flyTo(picture, place.centre, normal, 1.4 * place.radius);
  say(`${face.id}${face.name ? `, ${face.name}` : ""}`);
}

/** Half of the height of a view that is near a place, mm. */
function near({ cutter, drawn: { partRadius } }: PageState): number {
  return Math.min(0.7 * partRadius, Math.max(6 * cutter.radius, 0.08 * partRadius));
}

/** Beside the tool, so much of the part is seen about a worst spot, as a share of the tool's length: else the tool fills the picture. */
const BESIDE = 0.6;

/** Look at the sample shown and at all of the tool that stands there; `close`: at the sample and at what is in the way. What is to be added to what is said of it. */
export function showSpot(picture: Picture, close = false): string {
  const { state, stage: { table } } = picture;
  const { sample } = state;
  if (!sample) return "";
  picture.close = close;
  const there = state.inTheWay()?.point ?? null;
  const placed = state.toolShown ? state.placed() : null;
  const { view, note } = openView(picture, there ? [sample.point, there] : [sample.point], sample.normal, placed?.axis ?? null);
  const least = close ? 0.35 * near(state) : near(state);
  const ball = (centre: Vec, radius: number): Ring => ({ centre, radius, axis: null });
  const rings = [ball(sample.point, least), ...(there ? [ball(there, 0.3 * least)] : [])];
  if (placed && !close) {
    const tool = rounds(state, placed.tip, placed.axis);
    rings.push(...tool, ...around(state, sample.point, BESIDE * Math.max(...tool.map(({ centre }) => distance(centre, sample.point)))));
  }
  const aim = table.holding(view.turn, view.rise, placed || close ? rings : [ball(sample.point, least)]);
  table.fly(close ? aim : withPart(picture, aim, [sample.point, ...(there ? [there] : [])]));
  return note;
}

/** The corners of a box about the part's surface that is within a distance of a place. */
function around({ drawn }: PageState, place: Vec, within: number): Ring[] {
  const [low, high] = [[...place], [...place]];
  for (const point of drawn.partPoints()) {
    if (distance(point, place) > within) continue;
    point.forEach((x, k) => ([low[k], high[k]] = [Math.min(low[k], x), Math.max(high[k], x)]));
  }
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => low.map((x, k) => (bits & (1 << k) ? high[k] : x)) as Vec);
  return corners.map((centre) => ({ centre, radius: 0, axis: null }));
}

/** A tool that stands out of the picture by less than this is seen whole: nothing is won by cutting off its top. */
const NEARLY = 1.15;

/** Where all of a long tool would leave the part small: nearer, so that the part takes half of the picture, places within it. */
function withPart({ state, stage: { table } }: Picture, aim: Aim, places: Vec[]): Aim {
  const { drawn } = state;
  const { right, up } = table.frame(aim);
  const ways = [right, up];
  const aspects = [table.aspect, 1];
  const ends = (points: Iterable<Vec>, way: Vec): [number, number] => {
    let [low, high] = [Infinity, -Infinity];
    for (const point of points) [low, high] = [Math.min(low, dot(point, way)), Math.max(high, dot(point, way))];
    return [low, high];
  };
  const part = ways.map((way) => ends(drawn.partPoints(), way));
  // As seen, half of the picture's width or of its height.
  const most = Math.max(...part.map(([low, high], k) => (high - low) / (2 * PART * aspects[k])));
  const wide = Math.sqrt(seenOf(state, cross(right, up)) / (4 * table.aspect * TOOL));
  const half = Math.min(Math.max(Math.min(aim.half, most), wide), (most * PART) / LEAST);
  const whole = Math.max(aim.half, half);
  const seen = part.map(([low, high], k) => {
    const [at, room] = [dot(aim.target, ways[k]), whole * aspects[k]];
    return (Math.min(high, at + room) - Math.max(low, at - room)) / (2 * room);
  });
  if (aim.half <= NEARLY * half && Math.max(...seen) >= LEAST) return { ...aim, half: whole };
  // As much of the tool as there is room for beside the part.
  let { target } = aim;
  ways.forEach((way, k) => {
    const room = half * aspects[k];
    const [low, high] = ends(places, way);
    const [first, last] = [Math.min(part[k][0], low), Math.max(part[k][1], high)];
    const wanted = dot(aim.target, way);
    const held = last - first > 2 * room ? (low + high) / 2 : Math.min(first + 0.94 * room, Math.max(last - 0.94 * room, wanted));
    target = plus(target, way, held - wanted);
  });
  return { ...aim, target, half };
}

/** The area of the tool shown as it is seen along a direction, mm2: its sides, and the widest of its ends. */
function seenOf(state: PageState, back: Vec): number {
  const axis = state.placed()?.axis;
  if (!axis || !state.toolShown) return 0;
  const along = Math.min(1, Math.abs(dot(axis, back)));
  let [sides, widest] = [0, 0];
  for (const { points } of state.cutter.outline) {
    points.forEach(([radius, h], i) => {
      widest = Math.max(widest, radius);
      if (i) sides += Math.abs(h - points[i - 1][1]) * (radius + points[i - 1][0]);
    });
  }
  return sides * Math.sqrt(1 - along ** 2) + Math.PI * widest ** 2 * along;
}

/** The corners of the outline of the tool shown, turned about its axis. */
function rounds({ cutter }: PageState, tip: Vec, axis: Vec): Ring[] {
  return cutter.outline.flatMap(({ points }) => points.map(([radius, h]) => ({ centre: plus(tip, axis, h), radius, axis })));
}

/** A view, askew to the normal and to the tool axis if that can be, in which nothing hides the places, at least the first one; what is to be said of it. */
function openView({ clip, picker, stage: { table } }: Picture, places: Vec[], normal: Vec, axis: Vec | null): { view: View; note: string } {
  const wanted = table.towards(normal);
  const back = (view: View): Vec => table.frame({ ...table.aim, ...view }).back;
  const ideal = back(wanted);
  const worth = (way: Vec): number => dot(way, ideal) - (axis ? 1.5 * Math.max(0, Math.abs(dot(way, axis)) - SIDE) : 0);
  const every = [wanted];
  for (let turn = 0; turn < 360; turn += 15) for (let rise = -75; rise <= 85; rise += 10) every.push({ turn, rise });
  const sorted = every
    .map((view) => ({ view, way: back(view) }))
    .filter(({ way }) => dot(way, normal) > 0.1)
    .sort((a, b) => worth(b.way) - worth(a.way));
  const open = (most: number, seen: Vec[]): View | undefined =>
    sorted.slice(0, most).find(({ way }) => !seen.some((place) => picker.hidden(place, way)))?.view;
  const view = (places.length > 1 ? open(LOOKED_AT, places) : undefined) ?? open(sorted.length, places.slice(0, 1));
  if (view) return { view, note: "" };
  return { view: table.towards(clip.through(places[0], normal)), note: "It is hidden from every side: the part is clipped there." };
}

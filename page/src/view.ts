// Where to look from, so that a place of the surface is seen, and the tool that stands there.

import type { App } from "./app.ts";
import type { Aim, Ring, View } from "./camera.ts";
import type { Owner } from "./mesh.ts";
import type { Vec } from "./meta.ts";
import { cross, distance, dot, plus } from "./vectors.ts";

/** A tool is seen well from its side: up to this cosine between its axis and the way to the eye nothing is lost. */
const SIDE = 0.5;
/** Of so many views, the best ones first, it is asked whether something hides the place. */
const LOOKED_AT = 80;
/** At a worst spot the part has at least so much of the picture's width or height. */
const PART = 0.5;
/** And the tool not more than so much of the picture, as long as the part has so much of its width or height. */
const [TOOL, LEAST] = [0.4, 0.34];

/** Look at a place of the surface from its outer side, near enough to see what is there. */
export function flyTo(app: App, point: Vec, normal: Vec, size = near(app)): void {
  app.stage.table.fly({ target: point, half: size, ...openView(app, [point], normal, null) });
}

/** Look at a face along the normal of its middle triangle. */
export function showFace(app: App, owner: Owner): void {
  const { drawn, meta } = app;
  const place = drawn.middle(owner);
  const face = meta.faces[owner];
  if (!place) return app.say(`${face.id} is not drawn`);
  const first = drawn.triangle[3 * (face.start + (face.count >> 1))];
  const normal = [0, 1, 2].map((k) => drawn.normal[4 * first + k]) as Vec;
  flyTo(app, place.centre, normal, 1.4 * place.radius);
  app.say(`${face.id}${face.name ? `, ${face.name}` : ""}`);
}

/** Half of the height of a view that is near a place, mm. */
function near({ cutter, drawn: { partRadius } }: App): number {
  return Math.min(0.7 * partRadius, Math.max(6 * cutter.radius, 0.08 * partRadius));
}

/** Beside the tool, so much of the part is seen about a worst spot, as a share of the tool's length: else the tool fills the picture. */
const BESIDE = 0.6;

let isClose = false;
/** Whether the last look at a sample was a close one. */
export const closeNow = (): boolean => isClose;

/** Look at the sample shown and at all of the tool that stands there; `close`: at the sample and at what is in the way. */
export function showSpot(app: App, close = false): void {
  const { sample, stage: { table } } = app;
  if (!sample) return;
  isClose = close;
  const there = app.inTheWay()?.point ?? null;
  const placed = app.toolShown ? app.placed() : null;
  const axis = placed?.axis ?? null;
  const view = openView(app, there ? [sample.point, there] : [sample.point], sample.normal, axis);
  const least = close ? 0.35 * near(app) : near(app);
  const ball = (centre: Vec, radius: number): Ring => ({ centre, radius, axis: null });
  const rings = [ball(sample.point, least), ...(there ? [ball(there, 0.3 * least)] : [])];
  if (placed && !close) {
    const tool = rounds(app, placed.tip, placed.axis);
    rings.push(...tool, ...around(app, sample.point, BESIDE * Math.max(...tool.map(({ centre }) => distance(centre, sample.point)))));
  }
  const aim = table.holding(view.turn, view.rise, placed || close ? rings : [ball(sample.point, least)]);
  table.fly(close ? aim : withPart(app, aim, [sample.point, ...(there ? [there] : [])]));
}

/** The corners of a box about the part's surface that is within a distance of a place. */
function around({ drawn }: App, place: Vec, within: number): Ring[] {
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
function withPart(app: App, aim: Aim, places: Vec[]): Aim {
  const { drawn, stage: { table } } = app;
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
  const wide = Math.sqrt(seenOf(app, cross(right, up)) / (4 * table.aspect * TOOL));
  const half = Math.min(Math.max(Math.min(aim.half, most), wide), (most * PART) / LEAST);
  if (aim.half <= NEARLY * half) return { ...aim, half: Math.max(aim.half, half) };
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
function seenOf(app: App, back: Vec): number {
  const axis = app.placed()?.axis;
  if (!axis || !app.toolShown) return 0;
  const along = Math.min(1, Math.abs(dot(axis, back)));
  let [sides, widest] = [0, 0];
  for (const { points } of app.cutter.outline) {
    points.forEach(([radius, h], i) => {
      widest = Math.max(widest, radius);
      if (i) sides += Math.abs(h - points[i - 1][1]) * (radius + points[i - 1][0]);
    });
  }
  return sides * Math.sqrt(1 - along ** 2) + Math.PI * widest ** 2 * along;
}

/** The corners of the outline of the tool shown, turned about its axis. */
function rounds({ cutter }: App, tip: Vec, axis: Vec): Ring[] {
  return cutter.outline.flatMap(({ points }) => points.map(([radius, h]) => ({ centre: plus(tip, axis, h), radius, axis })));
}

/** A view, askew to the normal and to the tool axis if that can be, in which nothing hides the places; at least the first one. */
function openView(app: App, places: Vec[], normal: Vec, axis: Vec | null): View {
  const { table } = app.stage;
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
    sorted.slice(0, most).find(({ way }) => !seen.some((place) => app.picker.hidden(place, way)))?.view;
  const found = (places.length > 1 ? open(LOOKED_AT, places) : undefined) ?? open(sorted.length, places.slice(0, 1));
  if (found || !app.clip) return found ?? wanted;
  const way = app.clip.through(places[0], normal);
  app.note = "It is hidden from every side: the part is clipped there.";
  return table.towards(way);
}

// The legend of the picture: colour and pattern of what is seen, or the scale with its numbers.

import { colourOf, type Ramp, ramp, spoken } from "./colours.ts";
import { el, figure, percent, svg } from "./dom.ts";
import { swatch } from "./patterns.ts";
import { PROCESS } from "./plans.ts";
import type { PageState } from "./state.ts";

/** As in the style sheet: the picture stands above what is to be read. */
export const NARROW = matchMedia("(max-width: 999.98px)");

/** The picture has little room. */
const LOW = matchMedia("(max-height: 699.98px)");

/** It stands below the picture, never over it, and is folded where that has little room. */
export function legend(state: PageState): HTMLElement {
  const body = el("div", {});
  const title = el("summary", {}, "Legend");
  const folded = el("details", {}, title, body);
  const fold = (): void => void (folded.open = !NARROW.matches && !LOW.matches);
  for (const each of [NARROW, LOW]) each.addEventListener("change", fold);
  fold();
  state.on("look", () => {
    title.textContent = state.look.title;
    body.replaceChildren(...legendOf(state, false));
  });
  return el("aside", { id: "legend", "aria-label": "Legend" }, folded);
}

/** What is in the legend now, made anew: patterns of a hidden one are not drawn elsewhere. On paper the table of the process shows the steps. */
export function legendOf({ look, meta, mode }: PageState, printed = true): HTMLElement[] {
  const listed = printed && mode === PROCESS ? meta.process!.steps.map(({ label }) => label) : [];
  const rows = look.entries.filter(({ label }) => !listed.includes(label)).map((entry) =>
    el("li", {}, swatch(entry.colour, entry.pattern), entry.label, el("span", { class: "share" }, percent(entry.share ?? 0))),
  );
  const also = (word: string): void => void rows.push(el("li", {}, swatch(colourOf(meta, word), "plain"), spoken(meta, word)));
  if (meta.faces.some((face) => !face.target)) also("check");
  if (meta.fixtures.length) also("fixture");
  const found: HTMLElement[] = printed && !listed.length ? [el("h2", {}, look.title)] : [];
  if (look.ramp) found.push(scale(look.ramp));
  const inside = look.entries.some((entry) => entry.label === spoken(meta, "inside_bodies"));
  const hint = `share of the sampled area${inside ? " that lies inside no other body" : ""}`;
  if (look.entries.length) rows.push(el("li", { class: "hint" }, hint));
  found.push(el("ul", { class: "legend" }, ...rows));
  return found;
}

function scale({ low, high, unit, below, above }: Ramp): HTMLElement {
  const steps = 64;
  const bar = svg("svg", {
    class: "ramp",
    viewBox: `0 0 ${steps} 10`,
    preserveAspectRatio: "none",
    "shape-rendering": "crispEdges",
    "aria-hidden": "true",
  });
  for (let i = 0; i < steps; i++) bar.append(svg("rect", { x: i, y: 0, width: 1.05, height: 10, fill: ramp(i / (steps - 1)) }));
  const middle = (low + high) / 2;
  return el(
    "div",
    { class: "scale" },
    bar,
    el(
      "p",
      { class: "ticks" },
      el("span", {}, `${below ? "\u2264 " : ""}${figure(low)}`),
      el("span", {}, figure(middle)),
      el("span", {}, `${above ? "\u2265 " : ""}${figure(high)} ${unit}`),
    ),
  );
}

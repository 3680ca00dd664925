// The legend of the picture: colour and pattern of what is seen, or the scale with its numbers.

import type { App } from "./app.ts";
import { colourOf, ramp, spoken } from "./colours.ts";
import { el, figure, percent, svg } from "./dom.ts";
import { swatch } from "./patterns.ts";

export function legend(app: App): HTMLElement {
  const root = el("aside", { id: "legend", "aria-label": "Legend" });
  app.on("look", () => {
    const { look, meta } = app;
    if (!look) return;
    const rows = look.entries.map((entry) =>
      el(
        "li",
        {},
        swatch(entry.colour, entry.pattern),
        entry.label,
        el("span", { class: "share" }, percent(entry.share ?? 0)),
      ),
    );
    if (meta.faces.some((face) => !face.target)) rows.push(el("li", {}, swatch(colourOf(meta, "check"), "plain"), spoken("check")));
    if (meta.fixtures.length) rows.push(el("li", {}, swatch(colourOf(meta, "fixture"), "plain"), spoken("fixture")));
    root.replaceChildren(el("h2", {}, look.title), look.ramp ? scale(look.ramp) : "", el("ul", { class: "legend" }, ...rows));
    if (look.entries.length) root.append(el("p", { class: "hint" }, "share of the sampled area"));
  });
  return root;
}

function scale({ low, high, unit, below, above }: { low: number; high: number; unit: string; below: boolean; above: boolean }): HTMLElement {
  const steps = 64;
  const bar = svg("svg", { class: "ramp", viewBox: `0 0 ${steps} 10`, preserveAspectRatio: "none", "aria-hidden": "true" });
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

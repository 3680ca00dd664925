// The patterns of the legend and of the posture map: the second channel beside colour.

import type { Pattern } from "./meta.ts";
import { rgb } from "./colours.ts";
import { svg } from "./dom.ts";

/** Sides of a tile, pixels, and the lines in it. */
const TILES: Record<Pattern, { size: number; lines: [number, number, number, number][]; dots?: boolean }> = {
  plain: { size: 8, lines: [] },
  hatch: { size: 7, lines: [[0, 7, 7, 0], [-1, 1, 1, -1], [6, 8, 8, 6]] },
  back: { size: 7, lines: [[0, 0, 7, 7], [-1, 6, 1, 8], [6, -1, 8, 1]] },
  cross: { size: 8, lines: [[0, 0, 8, 8], [0, 8, 8, 0]] },
  bars: { size: 5, lines: [[0, 2.5, 5, 2.5]] },
  lines: { size: 5, lines: [[2.5, 0, 2.5, 5]] },
  dots: { size: 5, lines: [], dots: true },
};

const dark = (hex: string): string => `rgb(${rgb(hex).map((x) => Math.round(x * 0.45)).join(" ")})`;

/** A fill for a canvas. */
export function tile(context: CanvasRenderingContext2D, colour: string, pattern: Pattern): CanvasPattern | string {
  const { size, lines, dots } = TILES[pattern];
  if (!lines.length && !dots) return colour;
  const ratio = context.getTransform().a || 1;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = Math.round(size * ratio);
  const inner = canvas.getContext("2d")!;
  inner.scale(canvas.width / size, canvas.width / size);
  inner.fillStyle = colour;
  inner.fillRect(0, 0, size, size);
  inner.strokeStyle = inner.fillStyle = dark(colour);
  inner.lineWidth = 1.2;
  inner.beginPath();
  for (const [x, y, u, v] of lines) {
    inner.moveTo(x, y);
    inner.lineTo(u, v);
  }
  inner.stroke();
  if (dots) {
    inner.beginPath();
    inner.arc(size / 2, size / 2, 1.1, 0, 7);
    inner.fill();
  }
  const made = context.createPattern(canvas, "repeat")!;
  made.setTransform(new DOMMatrix().scale(1 / ratio));
  return made;
}

let made = 0;

/** A swatch for a legend. */
export function swatch(colour: string, pattern: Pattern): SVGSVGElement {
  const { size, lines, dots } = TILES[pattern];
  const id = `tile-${made++}`;
  const inside = lines.map(([x1, y1, x2, y2]) => svg("line", { x1, y1, x2, y2, stroke: dark(colour), "stroke-width": 1.3 }));
  return svg(
    "svg",
    { class: "swatch", width: 22, height: 14, "aria-hidden": "true" },
    svg(
      "pattern",
      { id, width: size, height: size, patternUnits: "userSpaceOnUse" },
      svg("rect", { width: size, height: size, fill: colour }),
      ...inside,
      dots ? svg("circle", { cx: size / 2, cy: size / 2, r: 1.2, fill: dark(colour) }) : null,
    ),
    svg("rect", { x: 0.5, y: 0.5, width: 21, height: 13, fill: `url(#${id})`, stroke: "#00000055" }),
  );
}

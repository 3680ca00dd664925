// The keyboard does all that the mouse does; the help says how.

import type { Alone } from "./alone.ts";
import type { App } from "./app.ts";
import { VIEWS } from "./camera.ts";
import type { Clip } from "./clip.ts";
import { button, el } from "./dom.ts";
import type { SpotList } from "./lists.ts";
import type { Measure } from "./measure.ts";
import { nextSubject } from "./operations.ts";
import type { Selection } from "./selection.ts";
import { closeNow, showSpot } from "./view.ts";

const HELP: [string, string][] = [
  ["Click, Enter", "show the posture map of the sample there (Enter: in the middle of the picture)"],
  ["Ctrl and click, s", "select the face there (s: of the pointer or the sample), to copy it as a choice of faces"],
  ["Drag, arrows", "turn the part (in the posture map: move the tool)"],
  ["Shift and drag, Ctrl and arrows", "shift the picture"],
  ["Wheel, + and -", "zoom"],
  ["o", "show the process, the cutter alone, or another plan of operations"],
  ["f", "fit the part into the picture"],
  ["w", "the picture in the whole window, and back"],
  ["l", "look at what stays, at its next side"],
  ["b", "hide or show fixtures and check faces"],
  ["1 to 7", "front, back, left, right, top, bottom, corner"],
  ["Shift and arrows, j and k", "step to a neighbouring sample"],
  ["n and p", "next and previous worst spot"],
  ["[ and ]", "previous and next cutter"],
  ["z", "look closely at the sample shown, or at all of its tool"],
  ["t", "show or hide the tool"],
  ["g", "see through the tool, or not"],
  ["c", "clip: off, across X, Y, Z"],
  ["m", "measure: between two points, or from the selected sample to the next one"],
  ["y", "copy a link to what is shown"],
  ["Escape", "leave the whole window, end measuring, leave the sample"],
  ["One finger, two, pinch", "turn the part, shift the picture, zoom"],
  ["?", "this help"],
];

export function helpDialog(): HTMLDialogElement {
  const rows = HELP.map(([keys, work]) => el("tr", {}, el("th", { scope: "row" }, keys), el("td", {}, work)));
  const dialog = el("dialog", { id: "help", "aria-labelledby": "help-title" });
  dialog.append(
    el("h2", { id: "help-title" }, "Mouse and keys"),
    el("table", {}, el("tbody", {}, ...rows)),
    button("Close", () => dialog.close()),
  );
  return dialog;
}

interface Parts {
  spots: SpotList;
  clip: Clip;
  measure: Measure;
  help: HTMLDialogElement;
  selection: Selection;
  alone: Alone;
  lost: () => void;
  link: () => void;
  glass: () => void;
  tool: () => void;
}

export function listenKeys(app: App, parts: Parts): void {
  const { table } = app.stage;
  document.addEventListener("keydown", (event) => {
    const where = event.target as HTMLElement;
    if (event.defaultPrevented || event.altKey || event.metaKey || parts.help.open) return;
    if (where.closest("input, select, textarea") || where.isContentEditable) return;
    if (arrow(event, where)) {
      event.preventDefault();
      return;
    }
    if (event.ctrlKey) return;
    const view = VIEWS[event.key];
    if (view) {
      table.fit(view[1], view[2]);
      app.say(`View: ${view[0]}`);
      return;
    }
    const works: Record<string, () => void> = {
      "+": () => table.zoom(1.25),
      "=": () => table.zoom(1.25),
      "-": () => table.zoom(0.8),
      f: () => table.fit(),
      n: () => parts.spots.step(1),
      p: () => parts.spots.step(-1),
      j: () => neighbour(app, 1),
      k: () => neighbour(app, 0),
      "[": () => nextCutter(app, -1),
      "]": () => nextCutter(app, 1),
      c: () => parts.clip.next(),
      m: () => parts.measure.toggle(),
      s: () => parts.selection.toggle(app.hot ?? app.faceShown()),
      o: () => nextSubject(app),
      z: () => lookClosely(app),
      t: parts.tool,
      g: parts.glass,
      w: () => parts.alone.toggle(),
      l: parts.lost,
      y: parts.link,
      b: () => app.eyes?.toggle(),
      "?": () => parts.help.showModal(),
      Escape: () => (parts.alone.on ? parts.alone.toggle() : parts.measure.on ? parts.measure.toggle() : app.select(null)),
    };
    works[event.key]?.();
  });

  const arrow = (event: KeyboardEvent, where: HTMLElement): boolean => {
    const way: Record<string, [number, number, number]> = {
      ArrowLeft: [-1, 0, 0],
      ArrowRight: [1, 0, 1],
      ArrowUp: [0, 1, 3],
      ArrowDown: [0, -1, 2],
    };
    const found = way[event.key];
    // Elsewhere in the page arrows scroll, as they do everywhere.
    if (!found || where !== app.stage.canvas) return false;
    const [x, y, side] = found;
    if (event.shiftKey) neighbour(app, side);
    else if (event.ctrlKey) table.pan(-0.08 * x, 0.08 * y);
    else table.orbit(8 * x, 8 * y);
    return true;
  };
}

/** Step to the sample next to the selected one on its face. */
function neighbour(app: App, side: number): void {
  const { sample } = app;
  if (!sample) {
    app.say("No sample is selected: press Enter in the picture");
    return;
  }
  const next = app.part.neighbours(sample.row)[side];
  if (next === null || app.samples.face.values[next] !== sample.face) {
    app.say("The face ends there");
    return;
  }
  app.select(next);
}

/** From all of the tool at the sample shown to a close look, and back. */
function lookClosely(app: App): void {
  if (!app.sample) return app.say("No sample is selected: press Enter in the picture");
  app.note = "";
  const close = !closeNow();
  showSpot(app, close);
  app.say(`${close ? "A close look" : "All of the tool"}. ${app.note}`);
}

function nextCutter(app: App, by: number): void {
  const { cutters } = app.meta;
  const at = cutters.indexOf(app.cutter);
  app.setCutter(cutters[(at + by + cutters.length) % cutters.length].id);
}

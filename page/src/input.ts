// Mouse, fingers and keys: what each of them does.

import { VIEWS } from "./camera.ts";
import { spoken } from "./colours.ts";
import { pictureKey, steer } from "./controls.ts";
import { button, el } from "./dom.ts";
import type { Selection, SpotList } from "./lists.ts";
import type { Measure } from "./over.ts";
import type { Picture } from "./picture.ts";
import type { PageState } from "./state.ts";
import { type Alone, nextSubject } from "./toolbar.ts";
import { showSpot } from "./views.ts";

/** What a pointer means in the picture: what lies under it is named, and a click chooses. */
export function listenPointer(picture: Picture, measure: Measure, selection: Selection, told: (text: string) => void): void {
  const { picker, stage, state } = picture;
  const hover = (x: number, y: number): void => {
    const found = picker.at(x, y);
    state.hover(found ? found.owner : null);
    if (!found) return told("");
    const face = state.meta.faces[found.owner];
    const name = face?.name && face.name !== face.id ? `, ${face.name}` : "";
    const verdict = found.sample === null ? "" : `: ${spoken(state.meta, state.samples.verdict(state.cutter.id, found.sample))}`;
    const operation = found.sample === null ? null : state.operationAt(found.sample);
    told(`${state.drawn.called(found.owner)}${name}${operation ? `: ${operation.label}, ${operation.turned}` : verdict}`);
  };

  /** What a click there does, or Enter in the middle of the picture. */
  const choose = (x: number, y: number): void => {
    const found = picker.at(x, y);
    if (measure.on) {
      if (found) measure.add(found.point);
      return;
    }
    if (!found || found.sample === null) {
      state.say(found ? `${state.drawn.called(found.owner)} has no samples` : "Nothing is there");
      return;
    }
    show(state, found.sample);
  };
  steer(stage, {
    hover,
    leave: () => {
      state.hover(null);
      told("");
    },
    choose: (x, y, event) => {
      if (event.ctrlKey || event.metaKey) selection.toggle(picker.at(x, y)?.owner ?? null);
      else choose(x, y);
    },
  });
  stage.canvas.addEventListener("keydown", (event) => {
    if (event.key !== "Enter") return;
    const middle = picker.at(0, 0);
    if (middle && (measure.on || middle.sample !== null)) return choose(0, 0);
    const near = nearestToMiddle(picture);
    if (near === null) return state.say("No sample is in the picture");
    if (measure.on) measure.add(state.samples.point(near));
    else show(state, near);
  });
}

/** Select a sample; where operations are shown, with the cutter that takes it. */
function show(state: PageState, row: number): void {
  const cutter = state.operationAt(row)?.cutter;
  if (cutter && cutter !== state.cutter.id) state.setCutter(cutter);
  state.select(row);
  const { meta, samples } = state;
  const face = state.faceShown();
  const reason = samples.reason(state.cutter.id, row);
  const verdict = spoken(meta, samples.verdict(state.cutter.id, row)) + (reason ? ` (${spoken(meta, reason)})` : "");
  // In a narrow window the posture map may be out of view.
  state.say(`${face === null ? "" : `${state.drawn.called(face)}, `}sample ${row}: ${verdict}`);
}

/** The sample that is drawn nearest to the middle of the picture and is not hidden; null where there is none. */
function nearestToMiddle({ picker, stage, state: { meta, samples } }: Picture): number | null {
  const { back } = stage.table.frame();
  const [w, h] = [stage.canvas.clientWidth, stage.canvas.clientHeight];
  const found: [number, number, number, number][] = [];
  for (let row = 0; row < samples.count; row++) {
    const normal = samples.normal(row);
    if (normal[0] * back[0] + normal[1] * back[1] + normal[2] * back[2] <= 0) continue;
    const [x, y] = stage.project(samples.point(row));
    const [u, v] = [(2 * x) / w - 1, 1 - (2 * y) / h];
    if (Math.abs(u) < 1 && Math.abs(v) < 1) found.push([u * u + v * v, row, u, v]);
  }
  found.sort((a, b) => a[0] - b[0]);
  for (const [, row, u, v] of found.slice(0, 40)) {
    const there = picker.at(u, v);
    if (there?.owner !== undefined && meta.faces[there.owner]?.number === samples.face.values[row]) return row;
  }
  return found.length ? found[0][1] : null;
}

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
  measure: Measure;
  help: HTMLDialogElement;
  selection: Selection;
  alone: Alone;
  /** Buttons that have a key. */
  pressed: Record<"lost" | "link" | "glass" | "tool", HTMLButtonElement>;
}

/** The keyboard does all that the mouse does; the help says how. */
export function listenKeys(picture: Picture, { alone, help, measure, pressed, selection, spots }: Parts): void {
  const { clip, eyes, stage: { canvas, table }, state } = picture;
  const side: Record<string, number> = { ArrowLeft: 0, ArrowRight: 1, ArrowDown: 2, ArrowUp: 3 };
  const works: Record<string, () => void> = {
    n: () => spots.step(1),
    p: () => spots.step(-1),
    j: () => neighbour(picture, 1),
    k: () => neighbour(picture, 0),
    "[": () => nextCutter(state, -1),
    "]": () => nextCutter(state, 1),
    c: () => clip.next(),
    m: () => measure.toggle(),
    s: () => selection.toggle(state.hot ?? state.faceShown()),
    o: () => nextSubject(state),
    z: () => lookClosely(picture),
    t: () => pressed.tool.click(),
    g: () => pressed.glass.click(),
    w: () => alone.toggle(),
    l: () => pressed.lost.click(),
    y: () => pressed.link.click(),
    b: () => eyes.toggle(),
    "?": () => help.showModal(),
    Escape: () => (alone.on ? alone.toggle() : measure.on ? measure.toggle() : state.select(null)),
  };
  document.addEventListener("keydown", (event) => {
    const where = event.target as HTMLElement;
    if (event.defaultPrevented || event.altKey || event.metaKey || help.open) return;
    if (where.closest("input, select, textarea") || where.isContentEditable) return;
    if (where === canvas && event.shiftKey && event.key in side) {
      event.preventDefault();
      neighbour(picture, side[event.key]);
    } else if (pictureKey(event, table, where === canvas)) {
      if (event.key in VIEWS) state.say(`View: ${VIEWS[event.key][0]}`);
    } else if (!event.ctrlKey) works[event.key]?.();
  });
}

/** Step to the sample next to the selected one on its face. */
function neighbour({ part, state }: Picture, side: number): void {
  const { sample } = state;
  if (!sample) {
    state.say("No sample is selected: press Enter in the picture");
    return;
  }
  const next = part.neighbours(sample.row)[side];
  if (next === null || state.samples.face.values[next] !== sample.face) {
    state.say("The face ends there");
    return;
  }
  state.select(next);
}

/** From all of the tool at the sample shown to a close look, and back. */
function lookClosely(picture: Picture): void {
  const { state } = picture;
  if (!state.sample) return state.say("No sample is selected: press Enter in the picture");
  const close = !picture.close;
  const note = showSpot(picture, close);
  state.say(`${close ? "A close look" : "All of the tool"}. ${note}`);
}

function nextCutter(state: PageState, by: number): void {
  const { cutters } = state.meta;
  const at = cutters.indexOf(state.cutter);
  state.setCutter(cutters[(at + by + cutters.length) % cutters.length].id);
}

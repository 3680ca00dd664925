// What a pointer means in the picture: what lies under it is named, and a click chooses.

import type { App } from "./app.ts";
import { spoken } from "./colours.ts";
import { steer } from "./controls.ts";
import type { Measure } from "./measure.ts";
import type { Selection } from "./selection.ts";

export function listen(app: App, measure: Measure, selection: Selection, told: (text: string) => void): void {
  const { canvas } = app.stage;
  const hover = (x: number, y: number): void => {
    const found = app.picker.at(x, y);
    app.hover(found ? found.owner : null);
    if (!found) return told("");
    const face = app.meta.faces[found.owner];
    const name = face?.name && face.name !== face.id ? `, ${face.name}` : "";
    const verdict = found.sample === null ? "" : `: ${spoken(app.meta, app.samples.verdict(app.cutter.id, found.sample))}`;
    const operation = found.sample === null ? null : app.operationAt(found.sample);
    told(`${app.drawn.called(found.owner)}${name}${operation ? `: ${operation.label}, ${operation.turned}` : verdict}`);
  };

  /** What a click there does, or Enter in the middle of the picture. */
  const choose = (x: number, y: number): void => {
    const found = app.picker.at(x, y);
    if (measure.on) {
      if (found) measure.add(found.point);
      return;
    }
    if (!found || found.sample === null) {
      app.say(found ? `${app.drawn.called(found.owner)} has no samples` : "Nothing is there");
      return;
    }
    show(app, found.sample);
  };
  steer(app.stage, {
    hover,
    leave: () => {
      app.hover(null);
      told("");
    },
    choose: (x, y, event) => {
      if (event.ctrlKey || event.metaKey) selection.toggle(app.picker.at(x, y)?.owner ?? null);
      else choose(x, y);
    },
  });
  canvas.addEventListener("keydown", (event) => {
    if (event.key !== "Enter") return;
    const middle = app.picker.at(0, 0);
    if (middle && (measure.on || middle.sample !== null)) return choose(0, 0);
    const near = nearestToMiddle(app);
    if (near === null) return app.say("No sample is in the picture");
    if (measure.on) measure.add(app.samples.point(near));
    else show(app, near);
  });
}

/** Select a sample; where operations are shown, with the cutter that takes it. */
function show(app: App, row: number): void {
  const cutter = app.operationAt(row)?.cutter;
  if (cutter && cutter !== app.cutter.id) app.setCutter(cutter);
  app.select(row);
  const { meta, samples } = app;
  const face = app.faceShown();
  const reason = samples.reason(app.cutter.id, row);
  const verdict = spoken(meta, samples.verdict(app.cutter.id, row)) + (reason ? ` (${spoken(meta, reason)})` : "");
  // In a narrow window the posture map may be out of view.
  app.say(`${face === null ? "" : `${app.drawn.called(face)}, `}sample ${row}: ${verdict}`);
}

/** The sample that is drawn nearest to the middle of the picture and is not hidden; null where there is none. */
function nearestToMiddle(app: App): number | null {
  const { samples, stage, picker } = app;
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
    if (there?.owner !== undefined && app.meta.faces[there.owner]?.number === samples.face.values[row]) return row;
  }
  return found.length ? found[0][1] : null;
}

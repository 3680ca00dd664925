// The panel of one sample: tilt against rotation, what is free, what forbids the rest, the posture shown, and the angles that hold it.

import { OUTERMOST, SINGULAR, STATES } from "./codes.ts";
import { causeOf, OPEN, spoken } from "./colours.ts";
import { button, coordinate, copyButton, degrees, el, figure, percent } from "./dom.ts";
import type { State } from "./live_map.ts";
import type { Position } from "./machine.ts";
import { swatch, tile } from "./patterns.ts";
import type { Judged, SampleMap } from "./sample_map.ts";
import { alike } from "./samples.ts";
import { styled } from "./scheme.ts";
import type { PageState } from "./state.ts";
import { cross, DEG, norm, turned } from "./vectors.ts";

/** Room around the map for its axes, pixels. */
const [LEFT, BOTTOM, TOP, RIGHT] = [30, 30, 10, 10];
/** What a posture meets, in place of what cannot be held or decided. */
const COLLISIONS: readonly State[] = OUTERMOST;
/** A larger radius of curvature, mm, is flat to whoever finishes it. */
const FLAT = 1000;
const HEIGHT = 226;

export class PosturePanel {
  readonly root = el("section", { id: "posture", "aria-label": "Posture map" });
  private readonly canvas = el("canvas", { id: "map", tabindex: 0, role: "application", "aria-describedby": "posture-line" });
  private readonly title = el("h2", {}, "Posture map");
  private readonly about = el("p", { class: "about" });
  private readonly kind = el("p", { class: "kind" });
  private readonly line = el("p", { id: "posture-line", "aria-live": "polite" });
  private readonly start = button("Posture found", () => this.back(), { id: "found-posture" });
  private readonly witness = el("p", { class: "hint" });
  /** Why the map and the plan name two causes. */
  private readonly differs = el("p", { class: "hint", id: "two-causes" });
  private readonly legend = el("ul", { class: "legend", "aria-label": "Legend of the posture map" });
  private readonly rows = el("tbody");
  private readonly caption = el("caption", {});
  private readonly intervals: HTMLElement;
  private readonly angles: Angles;
  /** What can be done at the sample; others add to it. */
  readonly tools = el("p", { class: "tools" }, this.start);
  private readonly body = el("div", { class: "posture-body" });
  private width = 320;
  private timer = 0;

  constructor(private readonly state: PageState) {
    this.angles = new Angles(state);
    const head = ["rotation, °", "free tilts, °", "else in the way"].map((text) => el("th", { scope: "col" }, text));
    this.intervals = el(
      "details",
      {},
      el("summary", {}, "The same as a table"),
      el("table", { id: "intervals" }, this.caption, el("thead", {}, el("tr", {}, ...head)), this.rows),
    );
    this.body.append(this.about, this.kind, this.canvas, this.line, this.angles.root, this.witness, this.tools, this.legend, this.differs, this.intervals);
    const leave = button("\u00d7", () => state.select(null), { class: "leave", title: "Leave the sample (Escape)", "aria-label": "Leave the sample" });
    this.root.append(leave, this.title, this.body);
    this.root.hidden = true;
    this.canvas.addEventListener("pointermove", (event) => this.point(event));
    this.canvas.addEventListener("pointerdown", (event) => this.point(event));
    this.canvas.addEventListener("keydown", (event) => this.key(event));
    state.on("sample", () => this.begin());
    state.on("posture", () => this.fill());
    new ResizeObserver(() => this.resize()).observe(this.root);
  }

  private resize(): void {
    const width = Math.max(220, Math.floor(this.root.clientWidth - 24));
    if (width === this.width) return;
    this.width = width;
    this.draw();
  }

  private begin(): void {
    window.clearTimeout(this.timer);
    const { cutter, map, meta, operation, sample, samples, spot } = this.state;
    // Without a sample the picture has all of the room.
    this.root.hidden = !sample;
    this.root.parentElement?.classList.toggle("chosen", !!sample);
    if (!sample || !map) return;
    const face = meta.faces.find((each) => each.number === sample.face);
    const verdict = samples.verdict(cutter.id, sample.row);
    const reason = samples.reason(cutter.id, sample.row);
    const served = meta.setups.length ? samples.setup(cutter.id, sample.row) : null;
    const setup = served === null ? "" : `, in setup ${served + 1}`;
    this.start.textContent = operation?.axis ? `Posture of ${operation.label}` : map.found ? "Posture found" : spot ? "Posture of the witness" : "Nearest posture";
    const named = `Posture map of sample ${sample.row}: tilt against rotation; arrow keys move the tool`;
    this.canvas.setAttribute("aria-label", named);
    this.about.replaceChildren(
      el("strong", {}, `${face?.id ?? "?"}, sample ${sample.row}`),
      ` at ${samples.told(sample.row).map((x) => coordinate(x)).join(", ")} mm. `,
      el("strong", {}, cutter.name || cutter.id),
      `: ${spoken(meta, verdict)}${reason ? ` (${spoken(meta, reason)})` : ""}${setup}. Curvature ${sample.curvature.map(bend).join(" and ")}.`,
    );
    this.kind.textContent = map.blocked
      ? "Nothing is called free here. What forbids the postures comes from the drawn triangles."
      : "Approximate: this map comes from the drawn triangles and overlooks what reaches less than " +
        `${figure(this.state.liveTool().spared, 2)} mm into the tool. It is not certified.`;
    if (meta.kinematics && meta.kinematics.direction.length < 2) {
      this.kind.textContent += " This machine turns too few axes for a map: only the posture found is shown.";
    }
    this.kind.classList.toggle("approximate", !map.blocked);
    this.differs.textContent = "";
    this.draw();
    this.timer = window.setTimeout(() => this.advance(map), 0);
  }

  /** Fill the map in slices, so that the page stays responsive. */
  private advance(map: SampleMap): void {
    if (map !== this.state.map) return;
    if (!map.complete) map.advance();
    this.draw();
    if (!map.complete) {
      this.timer = window.setTimeout(() => this.advance(map), 0);
      return;
    }
    this.table(map);
    this.root.dataset.complete = String(map.sample.row);
    if (!this.state.posture) {
      const start = this.firstFree(map) ?? map.nearest();
      if (start) this.state.setPosture(start);
    }
  }

  private firstFree(map: SampleMap): { tilt: number; rotation: number } | null {
    let best: [number, { tilt: number; rotation: number }] | null = null;
    map.grid.rotations.forEach((rotation, column) => {
      for (const [low, high] of map.free(column)) {
        if (!best || high - low > best[0]) best = [high - low, { tilt: Math.round((low + high) / 2), rotation }];
      }
    });
    return best ? best[1] : null;
  }

  private back(): void {
    const { map } = this.state;
    if (map) this.state.setPosture(this.state.startPosture(map.sample.row) ?? map.nearest());
  }

  private fill(): void {
    const { judged, map, operation, posture, spot } = this.state;
    const witness = this.state.atWitness();
    if (posture && judged && map) {
      const planned = this.state.plannedPosture();
      const of = planned && alike(planned, posture) ? `, ${operation!.label}` : "";
      const sure = of || (judged.state === "free" && map.found && alike(map.found, posture) ? ", the posture found" : "");
      const undecided = this.state.samples.verdict(this.state.cutter.id, map.sample.row) === "undecided";
      // The plan's sentence on its witness stands below; what the drawn triangles say there would be a second word for it.
      const words = witness ? `the best posture found, ${undecided ? "undecided" : "not free"}` : wording(this.state, judged) + sure;
      this.line.textContent = `tilt ${degrees(posture.tilt)}°, rotation ${degrees(posture.rotation)}°: ${words}`;
      this.line.dataset.state = judged.state;
    } else {
      this.line.textContent = "";
    }
    this.witness.textContent = witness ? spot!.text : "";
    this.draw();
  }

  // Places in the drawing.

  private x(rotation: number): number {
    return LEFT + ((this.width - LEFT - RIGHT) * turned(rotation + this.step / 2)) / 360;
  }

  private y(tilt: number): number {
    const [low, high] = this.state.meta.tilt_deg;
    return HEIGHT - BOTTOM - ((HEIGHT - BOTTOM - TOP) * (tilt - low)) / Math.max(1e-9, high - low);
  }

  private get step(): number {
    const turns = this.state.meta.rotation_deg;
    return turns.length > 1 ? turns[1] - turns[0] : 360;
  }

  draw(): void {
    const { canvas, state: { map } } = this;
    if (!map) return;
    const ratio = Math.min(2, devicePixelRatio || 1);
    canvas.width = this.width * ratio;
    canvas.height = HEIGHT * ratio;
    canvas.style.width = `${this.width}px`;
    canvas.style.height = `${HEIGHT}px`;
    const c = canvas.getContext("2d")!;
    c.scale(ratio, ratio);
    const fills = new Map(STATES.map((state) => [state, tile(c, ...causeOf(this.state.meta, state))]));
    const wide = Math.max(1, ((this.width - LEFT - RIGHT) * this.step) / 360 - 1);
    const seen = new Set<State>();
    const { tilts } = map.grid;
    map.grid.rotations.forEach((rotation, column) => {
      const x = this.x(rotation) - wide / 2;
      c.fillStyle = styled("ground");
      c.fillRect(x, TOP, wide, HEIGHT - TOP - BOTTOM);
      let from = 0;
      for (let row = 1; row <= tilts.length; row++) {
        const state = map.cell(column, from);
        if (row < tilts.length && map.cell(column, row) === state) continue;
        if (state && state !== "free") {
          seen.add(state);
          c.fillStyle = fills.get(state)!;
          const low = from ? (tilts[from - 1] + tilts[from]) / 2 : tilts[0];
          const high = row < tilts.length ? (tilts[row - 1] + tilts[row]) / 2 : tilts[row - 1];
          c.fillRect(x, this.y(high), wide, this.y(low) - this.y(high));
        }
        from = row;
      }
      c.fillStyle = OPEN[0];
      for (const [low, high] of map.free(column)) {
        seen.add("free");
        c.fillRect(x, this.y(high) - 0.5, wide, Math.max(1, this.y(low) - this.y(high) + 1));
      }
    });
    this.axes(c);
    this.marks(c);
    const shown = STATES.filter((state) => seen.has(state));
    const told = shown.join();
    if (this.legend.dataset.shown !== told) {
      this.legend.dataset.shown = told;
      this.legend.replaceChildren(
        ...shown.map((state) => {
          const open = state === "free";
          const word = open ? "nothing met (not certified)" : state === "tolerance" ? "within tolerance" : spoken(this.state.meta, state);
          return el("li", {}, swatch(...(open ? OPEN : causeOf(this.state.meta, state))), word);
        }),
      );
    }
  }

  private axes(c: CanvasRenderingContext2D): void {
    const [low, high] = this.state.meta.tilt_deg;
    c.fillStyle = styled("soft");
    c.font = "11px system-ui, sans-serif";
    c.textAlign = "right";
    c.textBaseline = "middle";
    for (let k = 0; k <= 3; k++) {
      const tilt = low + ((high - low) * k) / 3;
      c.fillText(String(Math.round(tilt)), LEFT - 5, this.y(tilt));
    }
    c.textAlign = "center";
    c.textBaseline = "top";
    for (const turn of [0, 90, 180, 270]) c.fillText(String(turn), this.x(turn), HEIGHT - BOTTOM + 4);
    c.fillText("rotation, °", LEFT + (this.width - LEFT - RIGHT) / 2, HEIGHT - 13);
    c.save();
    c.translate(2, TOP + (HEIGHT - TOP - BOTTOM) / 2);
    c.rotate(-Math.PI / 2);
    c.fillText("tilt, °", 0, 0);
    c.restore();
  }

  private marks(c: CanvasRenderingContext2D): void {
    const { map, posture } = this.state;
    const found = map?.found;
    const ring = (x: number, y: number, r: number, colour: string, width: number): void => {
      c.strokeStyle = colour;
      c.lineWidth = width;
      c.beginPath();
      c.arc(x, y, r, 0, 7);
      c.stroke();
    };
    if (found) {
      const [x, y] = [this.x(found.rotation), this.y(found.tilt)];
      c.beginPath();
      for (const [dx, dy] of [[0, -6], [6, 0], [0, 6], [-6, 0]]) c.lineTo(x + dx, y + dy);
      c.closePath();
      c.fillStyle = "#fff";
      c.fill();
      c.strokeStyle = "#111";
      c.lineWidth = 1.5;
      c.stroke();
    }
    if (!posture) return;
    const [x, y] = [this.x(posture.rotation), this.y(posture.tilt)];
    ring(x, y, 8, "#fff", 4);
    ring(x, y, 8, "#111", 2);
  }

  // Moving over it.

  private point(event: PointerEvent): void {
    const { map } = this.state;
    if (!map) return;
    const box = this.canvas.getBoundingClientRect();
    const across = (event.clientX - box.left - LEFT) / (this.width - LEFT - RIGHT);
    const [low, high] = this.state.meta.tilt_deg;
    const up = (HEIGHT - BOTTOM - (event.clientY - box.top)) / (HEIGHT - BOTTOM - TOP);
    if (across < 0 || across > 1) return;
    const column = map.column(turned(360 * across - this.step / 2));
    const tilt = Math.round(Math.min(high, Math.max(low, low + up * (high - low))));
    this.go(column, Math.min(high, Math.max(low, tilt)));
  }

  private go(column: number, tilt: number): void {
    const rotation = this.state.map!.grid.rotations[column];
    const now = this.state.posture;
    if (now && now.tilt === tilt && now.rotation === rotation) return;
    this.state.setPosture({ tilt, rotation });
  }

  private key(event: KeyboardEvent): void {
    const way: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, 1],
      ArrowDown: [0, -1],
      PageUp: [0, 10],
      PageDown: [0, -10],
    };
    const step = way[event.key];
    const { map, posture } = this.state;
    if (!step || !map || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    const turns = map.grid.rotations.length;
    const [low, high] = this.state.meta.tilt_deg;
    const column = posture ? map.column(posture.rotation) : 0;
    const tilt = Math.round(posture?.tilt ?? low) + step[1];
    this.go((column + step[0] + turns) % turns, Math.min(high, Math.max(low, tilt)));
  }

  private table(map: SampleMap): void {
    this.rows.replaceChildren(
      ...map.grid.rotations.map((rotation, column) => {
        const free = map.free(column).map(([low, high]) => `${degrees(low)} to ${degrees(high)}`);
        const causes = [...map.causes(column)].sort((a, b) => b[1] - a[1]).map(([state]) => spoken(this.state.meta, state));
        return el(
          "tr",
          { "data-rotation": rotation },
          el("th", { scope: "row" }, degrees(rotation)),
          el("td", {}, free.join("; ") || "none"),
          el("td", {}, causes.join(", ")),
        );
      }),
    );
    const cells = map.grid.rotations.length * map.grid.tilts.length;
    let open = 0;
    map.grid.rotations.forEach((_, k) => map.grid.tilts.forEach((__, i) => (open += map.cell(k, i) === "free" ? 1 : 0)));
    this.title.textContent = `Posture map: ${percent(open / cells)} ${map.blocked ? "free" : "open"}`;
    this.compare(map);
    this.caption.textContent = map.blocked ? "Free tilts by rotation" : "Tilts at which nothing is met, not certified";
  }

  /** The map names what each posture meets first, the plan what would have to change: where these differ one must know it. */
  private compare(map: SampleMap): void {
    const reason = this.state.samples.reason(this.state.cutter.id, map.sample.row);
    const cells = new Map<State, number>();
    map.grid.rotations.forEach((_, column) => {
      for (const [state, count] of map.causes(column)) cells.set(state, (cells.get(state) ?? 0) + count);
    });
    const [most] = [...cells].filter(([state]) => COLLISIONS.includes(state)).sort((a, b) => b[1] - a[1])[0] ?? [];
    this.differs.textContent =
      reason && most && most !== reason
        ? `The colours name what each posture meets first, mostly ${spoken(this.state.meta, most)}. The plan's reason, ` +
          `${spoken(this.state.meta, reason)}, names what to change first so that the sample can be reached.`
        : "";
  }
}

/** A curvature as planners think of it: a radius. */
function bend(curvature: number): string {
  if (!Number.isFinite(curvature)) return "unknown";
  if (Math.abs(curvature) * FLAT <= 1) return "flat";
  return `${curvature > 0 ? "concave" : "convex"} R ${figure(1 / Math.abs(curvature))}`;
}

/** What is said of the posture shown: `free`, or what is in the way. */
function wording({ drawn, met, meta }: PageState, { state, certified }: Judged): string {
  if (state === "free") return certified ? "free" : "nothing is met in the drawing, which is not certified";
  if (state === "undecided") return "undecided: neither called free nor known to be forbidden";
  const word = spoken(meta, state);
  const owner = met && met.owner !== null ? drawn.called(met.owner) : "";
  if (state === "fixture") return `${met?.part ?? "cutter"} meets ${owner}`;
  return owner ? `${word} with ${owner}` : `${word}: ${meta.causes[state].sentence}`;
}

const DIGITS = { angle: 2, axis: 4 };
/** Sine of an angle between tool axes that are one. */
const SAME = 1e-6;

/** The tool axis at the posture shown, and the positions of the rotary axes that hold it. */
class Angles {
  readonly root = el("div", { id: "angles" });

  constructor(private readonly state: PageState) {
    state.on("posture", () => this.fill());
  }

  private fill(): void {
    const { machine, meta: { axes: names }, operation } = this.state;
    const axis = this.state.placed()?.axis;
    this.root.hidden = !axis;
    if (!axis) return;
    const vector = axis.map((x) => plain(x, DIGITS.axis)).join(", ");
    const rows = [this.row("Tool axis", vector, "", `Copy the tool axis ${vector}`)];
    const { kinematics } = machine;
    const found = names.length ? machine.positions(axis) : [];
    if (kinematics && names.length && !found.length) rows.push(el("p", { class: "hint" }, `No angles of ${names.join(" and ")} hold this tool axis.`));
    found.forEach((each, i) => {
      const words = wordsOf(names, each);
      const named = found.length > 1 ? `Solution ${i + 1}` : names.length > 1 ? "Angles" : "Angle";
      rows.push(this.row(named, words.join(", "), beyond(names, each), `Copy ${words.join(" ")}`, words.join(" ")));
    });
    if (operation?.axis && norm(cross(axis, operation.axis)) < SAME) rows.push(...operation.words.map((each) => this.row("Control", each, "", `Copy ${each}`)));
    const near = kinematics && kinematics.direction.length === 2 && found.length > 0 ? norm(cross(axis, kinematics.direction[0])) : 1;
    if (near <= Math.sin(SINGULAR / DEG)) rows.push(el("p", { class: "hint" }, `Singular: the tool axis is nearly along ${names[0]}, which turns fast there.`));
    this.root.replaceChildren(...rows);
  }

  /** What is copied leaves the words behind that stand beside it. */
  private warning(more: string): string {
    const { judged } = this.state;
    const free = judged?.state === "free" ? (judged.certified ? "" : ". This posture is not certified") : ". This posture is not free";
    return `${free}${more ? `. ${more.charAt(0).toUpperCase()}${more.slice(1)}` : ""}`;
  }

  private row(named: string, text: string, more: string, label: string, copied = text): HTMLElement {
    const said = more ? el("span", { class: "hint" }, ` ${more}`) : null;
    return el("p", { class: "angle" }, el("span", { class: "what" }, named), el("span", { class: "value" }, text, said), copyButton("Copy", () => copied, (said) => this.state.say(said + this.warning(more)), label));
  }
}

/** Words of a program such as `A-12.5`, in the order of the letters. */
const wordsOf = (names: string[], { angles }: Position): string[] =>
  names.map((name, k) => `${name}${plain(angles[k], DIGITS.angle)}`).sort();

function beyond(names: string[], { within, free }: Position): string {
  const out = names.filter((_, k) => !within[k]);
  if (out.length) return `beyond the limit of ${out.join(" and ")}`;
  return free ? `any ${names[0]} serves` : "";
}

/** A number with so many digits behind the point, without zeros that say nothing. */
function plain(value: number, digits: number): string {
  const rounded = Number(value.toFixed(digits));
  return String(Object.is(rounded, -0) ? 0 : rounded);
}


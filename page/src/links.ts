// Links by `#`: a place, a cutter and a view, so that "look at F61" in a mail leads there.

import type { Aim } from "./camera.ts";
import { modesOf } from "./colours.ts";
import { copyButton } from "./dom.ts";
import type { Vec } from "./meta.ts";
import type { Picture } from "./picture.ts";
import { firstMode } from "./plans.ts";
import { alike, type Posture } from "./samples.ts";
import { distance, mixed, turned } from "./vectors.ts";
import { flyTo, showFace } from "./views.ts";

/** What is written of a face alone, as people type it. */
const FACE = /^F\d+$/i;
const KEYS = ["cutter", "face", "sample", "posture", "colours", "view"];
/** A turn of more degrees is none that this page wrote: rounding leaves nothing of a further one. */
const MOST_TURN = 1e6;
/** Digits of an angle, and of a length as a share of the part's radius: finer than a pixel. */
const [ANGLE, FINE] = [2, 1e-5];

export class Links {
  readonly button: HTMLButtonElement;
  /** What this page wrote into the address itself: that needs no jump. */
  private mine = "";

  constructor(private readonly picture: Picture) {
    this.button = copyButton("Copy link", () => this.keep(), picture.state.say, "Copy link to what is shown: cutter, sample and view (y)");
    window.addEventListener("hashchange", () => {
      if (location.hash === this.mine) return;
      this.mine = "";
      this.follow();
    });
  }

  /** The address of what is shown, which the browser's address line has from now on, too. */
  private keep(): string {
    this.mine = this.text();
    const address = `${location.href.split("#")[0]}${this.mine}`;
    try {
      history.replaceState(null, "", this.mine);
    } catch {
      // Within another page the address may not be changed: the text is all that is needed.
    }
    return address;
  }

  /** What is shown, as the part of an address from `#` on. */
  text(): string {
    const { stage, state } = this.picture;
    const { cutter, sample, posture, mode, meta } = state;
    const { target, half, turn, rise } = stage.table.aim;
    const fine = FINE * stage.table.radius;
    const short = (length: number): number => Number((Math.round(length / fine) * fine).toPrecision(8));
    const words: [string, string][] = [["cutter", cutter.id]];
    if (sample) words.push(["face", meta.faces[state.faceShown()!]?.id ?? ""], ["sample", String(sample.row)]);
    if (sample && posture && !same(posture, state.startPosture(sample.row))) words.push(["posture", [posture.tilt, posture.rotation].map((angle) => Number(angle.toFixed(ANGLE))).join()]);
    if (mode !== firstMode(meta)) words.push(["colours", mode]);
    words.push(["view", [Number(turn.toFixed(ANGLE)), Number(rise.toFixed(ANGLE)), ...[half, ...target].map(short)].join()]);
    return `#${words.map(([key, value]) => `${key}=${encodeURIComponent(value).replaceAll("%2C", ",")}`).join("&")}`;
  }

  /** Show what the address asks for; what is not in this plan is reported and left out. Whether it asked for something. */
  follow(): boolean {
    const { picture, picture: { state } } = this;
    const { faces, cutters } = state.meta;
    let text = location.hash.slice(1);
    try {
      text = decodeURIComponent(text);
    } catch {
      // A stray percent sign: the words are read as they stand.
    }
    if (FACE.test(text)) {
      const owner = faces.findIndex((each) => each.id.toLowerCase() === text.toLowerCase());
      if (owner < 0) state.say(`The link names ${text}, which is not in this plan`);
      else showFace(picture, owner);
      return owner >= 0;
    }
    const words = new URLSearchParams(location.hash.slice(1));
    if (!KEYS.some((key) => words.has(key))) {
      // An id of the page is a link of its browser.
      if (text && !document.getElementById(text)) state.say(`The link is not understood: #${text.slice(0, 40)}`);
      return false;
    }
    const missing: string[] = [];
    const cutter = words.get("cutter");
    if (cutter !== null) {
      if (!cutters.some(({ id }) => id === cutter)) missing.push(`cutter ${cutter}`);
      else if (cutter !== state.cutter.id) state.setCutter(cutter);
    }
    const mode = words.get("colours");
    if (mode !== null) {
      if (modesOf(state.meta).some(({ key }) => key === mode)) state.setMode(mode);
      else missing.push("its colours");
    }
    const named = words.get("face")?.toUpperCase() ?? null;
    const owner = faces.findIndex(({ id }) => id.toUpperCase() === named);
    const digits = words.get("sample");
    if (digits !== null) {
      const row = /^\d+$/.test(digits) ? Number(digits) : Number.NaN;
      const face = row < state.samples.count ? faces.find(({ number }) => number === state.samples.face.values[row]) : undefined;
      // Samples of another plan have other numbers: the face tells.
      if (!face || (named !== null && named !== face.id.toUpperCase())) missing.push(`sample ${words.get("sample")} of ${words.get("face") ?? "a face"}`);
      else {
        state.select(row);
        flyTo(picture, state.samples.point(row) as Vec, state.samples.normal(row));
        const [low, high] = state.meta.tilt_deg;
        const [tilt, rotation] = numbersOf(words.get("posture"), 2) ?? [];
        if (tilt >= low && tilt <= high) state.setPosture({ tilt, rotation: turned(rotation) });
        else if (words.has("posture")) missing.push("its posture");
      }
    } else if (named !== null) {
      if (owner < 0) missing.push(named);
      else showFace(picture, owner);
    }
    const view = this.viewOf(words.get("view"));
    if (view) picture.stage.table.fly(view);
    else if (words.has("view")) missing.push("its view");
    state.say(missing.length ? `Not in this plan: ${missing.join(", ")}. The link may be of another plan of this part.` : "The link's place is shown");
    return true;
  }

  private viewOf(text: string | null): Aim | null {
    const found = numbersOf(text, 6);
    if (!found) return null;
    const [turn, rise, half, ...target] = found;
    const [least, most] = this.picture.stage.table.halves;
    const { low, high } = this.picture.state.meta.part;
    const far = distance(target as Vec, mixed(low, 0.5, high, 0.5));
    if (Math.abs(turn) > MOST_TURN || Math.abs(rise) > 90 || half < least || half > most || far > 2 * most) return null;
    return { turn, rise, half, target: target as Vec };
  }
}

const same = (a: Posture, b: Posture | null): boolean => b !== null && alike(a, b);

/** So many finite numbers in a text; null where there are not so many. */
function numbersOf(text: string | null, count: number): number[] | null {
  const found = (text ?? "").split(",").map((each) => (each.trim() ? Number(each) : Number.NaN));
  return found.length === count && found.every(Number.isFinite) ? found : null;
}

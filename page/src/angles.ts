// The tool axis at the posture shown, and the positions of the rotary axes that hold it.

import type { App } from "./app.ts";
import { SINGULAR } from "./codes.ts";
import { copyButton } from "./copy.ts";
import { el } from "./dom.ts";
import type { Position } from "./machine.ts";
import { cross, DEG, norm } from "./vectors.ts";

const DIGITS = { angle: 2, axis: 4 };
/** Sine of an angle between tool axes that are one. */
const SAME = 1e-6;

export class Angles {
  readonly root = el("div", { id: "angles" });

  constructor(private readonly app: App) {
    app.on("posture", () => this.told());
  }

  private told(): void {
    const { app } = this;
    const axis = app.placed()?.axis;
    this.root.hidden = !axis;
    if (!axis) return;
    const vector = axis.map((x) => plain(x, DIGITS.axis)).join(", ");
    const rows = [this.row("Tool axis", vector, "", `Copy the tool axis ${vector}`)];
    const { kinematics } = app.machine;
    const names = app.meta.axes;
    const found = names.length ? app.machine.positions(axis) : [];
    if (kinematics && names.length && !found.length) rows.push(el("p", { class: "hint" }, `No angles of ${names.join(" and ")} hold this tool axis.`));
    found.forEach((each, i) => {
      const words = wordsOf(names, each);
      const named = found.length > 1 ? `Solution ${i + 1}` : names.length > 1 ? "Angles" : "Angle";
      rows.push(this.row(named, words.join(", "), beyond(names, each), `Copy ${words.join(" ")}`, words.join(" ")));
    });
    const { operation } = app;
    if (operation?.axis && norm(cross(axis, operation.axis)) < SAME) rows.push(...operation.words.map((each) => this.row("Control", each, "", `Copy ${each}`)));
    const near = kinematics && kinematics.direction.length === 2 && found.length > 0 ? norm(cross(axis, kinematics.direction[0])) : 1;
    if (near <= Math.sin(SINGULAR / DEG)) rows.push(el("p", { class: "hint" }, `Singular: the tool axis is nearly along ${names[0]}, which turns fast there.`));
    this.root.replaceChildren(...rows);
  }

  /** What is copied leaves the words behind that stand beside it. */
  private warning(more: string): string {
    const { state } = this.app;
    const free = state?.state === "free" ? (state.certified ? "" : ". This posture is not certified") : ". This posture is not free";
    return `${free}${more ? `. ${more.charAt(0).toUpperCase()}${more.slice(1)}` : ""}`;
  }

  private row(named: string, text: string, more: string, label: string, copied = text): HTMLElement {
    const said = more ? el("span", { class: "hint" }, ` ${more}`) : null;
    return el("p", { class: "angle" }, el("span", { class: "what" }, named), el("span", { class: "value" }, text, said), copyButton("Copy", () => copied, (said) => this.app.say(said + this.warning(more)), label));
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


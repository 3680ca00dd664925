// Eyes: what of the part and around it is in the picture. What is hidden still stands in the way of tools.

import { colourOf } from "./colours.ts";
import { el, menu } from "./dom.ts";
import type { Owner } from "./mesh.ts";
import type { Meta } from "./meta.ts";
import { swatch } from "./patterns.ts";
import type { PageState } from "./state.ts";

export interface Body {
  key: string;
  name: string;
  owners: Owner[];
}

/** What can be hidden: each fixture, the faces that are only looked at or left out, and each component where there are several. */
export function bodiesOf(meta: Meta): Body[] {
  const found = new Map<string, Body>();
  const add = (key: string, name: string, owner: Owner): void => {
    const body = found.get(key) ?? { key, name, owners: [] };
    body.owners.push(owner);
    found.set(key, body);
  };
  // One fixture may stand in several setups.
  meta.fixtures.forEach(({ name, count }, i) => count && add(`fixture:${name}`, name.replace(/^fixture:/, ""), -1 - i));
  meta.faces.forEach((face, i) => {
    if (face.ignored) add("ignored", "ignored faces", i);
    else if (!face.target) add("check", "check faces", i);
  });
  if (new Set(meta.faces.map(({ component }) => component)).size > 1) {
    meta.faces.forEach(({ component }, i) => add(`component:${component}`, component || "part without a name", i));
  }
  // What is all that there is cannot be hidden.
  return [...found.values()].filter(({ key, owners }) => key.startsWith("fixture:") || owners.length < meta.faces.length);
}

export class Eyes {
  /** Null where there is nothing to hide. */
  readonly root: HTMLElement | null;
  private readonly bodies: Body[];
  private readonly boxes = new Map<string, { box: HTMLInputElement; said: HTMLElement }>();
  private readonly hidden = new Set<string>();
  private readonly faded = new Set<string>();

  constructor(private readonly state: PageState) {
    this.bodies = bodiesOf(state.meta);
    this.root = this.bodies.length ? this.menu() : null;
  }

  private menu(): HTMLElement {
    const rows = this.bodies.map((body) => {
      const box = el("input", { type: "checkbox", checked: true, "data-body": body.key });
      const said = el("span", { class: "hint" });
      box.addEventListener("change", () => this.show(body.key, box.checked));
      this.boxes.set(body.key, { box, said });
      const word = body.key === "check" || body.key.startsWith("fixture:") ? body.key.split(":")[0] : null;
      return el("label", {}, box, word ? swatch(colourOf(this.state.meta, word), "plain") : null, el("span", {}, body.name), said);
    });
    return menu("eyes", "Bodies", "Show or hide fixtures and bodies (b)", ...rows);
  }

  private show(key: string, shown: boolean): void {
    this.faded.delete(key);
    if (shown) this.hidden.delete(key);
    else this.hidden.add(key);
    this.update();
    this.state.say(`${this.bodies.find((each) => each.key === key)?.name}: ${shown ? "shown" : "hidden, but still in the way of the tool"}`);
  }

  /** All but the part: hidden if one is seen, else shown. */
  toggle(): void {
    const around = this.bodies.filter(({ key }) => !key.startsWith("component:"));
    if (!around.length) return this.state.say("Nothing but the part is there");
    const hide = around.some(({ key }) => !this.hidden.has(key));
    this.faded.clear();
    for (const { key } of around) {
      if (hide) this.hidden.add(key);
      else this.hidden.delete(key);
    }
    this.update();
    this.state.say(hide ? "Only the part is shown; the rest is still in the way of the tool" : "All is shown");
  }

  /** Let one see through the bodies that some owners are of; their names. */
  fade(owners: ReadonlySet<Owner>): string[] {
    const found = this.bodies.filter((body) => body.owners.some((owner) => owners.has(owner)));
    for (const { key } of found) this.faded.add(key);
    if (found.length) this.update();
    return found.map(({ name }) => name);
  }

  private update(): void {
    const owners = (keys: ReadonlySet<string>): Owner[] => this.bodies.flatMap((body) => (keys.has(body.key) ? body.owners : []));
    for (const key of this.hidden) this.faded.delete(key);
    for (const [key, { box, said }] of this.boxes) {
      box.checked = !this.hidden.has(key);
      said.textContent = this.faded.has(key) ? "seen through" : "";
    }
    this.state.veil(owners(this.hidden), owners(this.faded));
  }
}

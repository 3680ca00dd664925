// The clipping plane: across an axis of the part, with caps where it cuts closed bodies.

import { Mesh, NotEqualStencilFunc, PlaneGeometry, Vector3, ZeroStencilOp } from "./three";
import type { App } from "./app.ts";
import { closed } from "./closed.ts";
import { colourOf } from "./colours.ts";
import { button, coordinate, el } from "./dom.ts";
import type { Owner } from "./mesh.ts";
import type { Vec } from "./meta.ts";
import { capMaterial, countingMaterial, shared } from "./shading.ts";
import { axis, distance, mixed } from "./vectors.ts";

export class Clip {
  readonly root = el("fieldset", { id: "clip" });
  private readonly slider = el("input", {
    type: "range",
    min: 0,
    max: 1000,
    step: "any",
    value: 500,
    "aria-label": "Place of the clipping plane",
  });
  private readonly axis = el("select", { "aria-label": "Clipping plane" });
  private readonly text = el("output", { class: "number" });
  private readonly note = el("span", { class: "hint" });
  private readonly caps: Mesh[] = [];
  private readonly counters: Mesh[] = [];
  /** Of each cap and its counter, an owner of what they cut. */
  private readonly owners: Owner[] = [];
  private sign = 1;
  private built = false;

  constructor(private readonly app: App) {
    const choices = [["", "off"], ["0", "across X"], ["1", "across Y"], ["2", "across Z"]];
    for (const [value, label] of choices) {
      this.axis.append(el("option", { value }, label));
    }
    this.axis.addEventListener("change", () => this.turn());
    this.slider.addEventListener("input", () => this.update());
    const flip = button("Flip", () => {
      this.sign = -this.sign;
      this.update();
    });
    this.root.append(el("legend", {}, "Clip"), this.axis, this.slider, this.text, flip, this.note);
    this.update();
  }

  /** Off, X, Y, Z and off again. */
  next(): void {
    this.axis.selectedIndex = (this.axis.selectedIndex + 1) % this.axis.options.length;
    this.turn();
    const where = `${this.axis.selectedOptions[0].text} at ${this.text.value}`;
    this.app.say(this.on ? `Clipped ${where}. ${this.note.textContent}` : "Clipping off");
  }

  /** Another plane: its cut faces the eye. */
  private turn(): void {
    this.own = false;
    if (this.on) this.sign = this.app.stage.table.frame().back[Number(this.axis.value)] < 0 ? -1 : 1;
    this.update();
  }

  /** Cut through a place of the surface that is hidden otherwise; the direction from which the cut is seen. */
  through(point: Vec, normal: Vec): Vec {
    const size = normal.map(Math.abs);
    // Along the normal and along the setup axis one would see the cut from its edge, or what is machined from below.
    const rank = size.map((x, k) => x + 0.9 * Math.abs(this.app.meta.setup.z[k]));
    const k = rank.indexOf(Math.min(...rank));
    const { low, high } = this.app.meta.part;
    const middle = (low[k] + high[k]) / 2;
    this.axis.value = String(k);
    this.slider.value = String((1000 * (point[k] - low[k])) / (high[k] - low[k] || 1));
    this.sign = point[k] < middle ? -1 : 1;
    this.own = true;
    this.update();
    return axis(k, this.sign);
  }

  /** End a cut that was made to show a hidden place. */
  release(): void {
    if (!this.own) return;
    this.own = false;
    this.axis.value = "";
    this.update();
  }

  private own = false;

  private get on(): boolean {
    return this.axis.value !== "";
  }

  private update(): void {
    const { low, high } = this.app.meta.part;
    for (const each of this.root.querySelectorAll<HTMLElement>("input, output, button, .hint")) each.hidden = !this.on;
    const plane = shared.plane.value;
    if (!this.on) {
      plane.set(0, 0, 0, 1);
    } else {
      if (!this.built) this.build();
      const k = Number(this.axis.value);
      const at = low[k] + ((high[k] - low[k]) * Number(this.slider.value)) / 1000;
      const normal = axis(k, this.sign);
      plane.set(...normal, this.sign * at);
      this.text.value = `${"XYZ"[k]} ${coordinate(at)} mm`;
      const middle = mixed(low, 0.5, high, 0.5);
      middle[k] = at;
      for (const cap of this.caps) {
        cap.position.set(...middle);
        cap.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), new Vector3(...normal));
      }
    }
    this.stand();
    this.app.stage.request();
  }

  /** Cap what is there in the setup that is shown. */
  stand(): void {
    for (const meshes of [this.caps, this.counters]) {
      meshes.forEach((mesh, i) => (mesh.visible = this.on && this.app.drawn.solid(this.owners[i])));
    }
  }

  /** Turn a bit over, pixel by pixel, for each surface behind the plane: where their number is odd the plane lies in a body. */
  private build(): void {
    this.built = true;
    const { drawn, meta, stage } = this.app;
    const { low, high } = meta.part;
    const open: string[] = [];
    const bodies: [string, number, number, string, Owner][] = [["the part", 0, drawn.ofFaces, "#8f8577", 0]];
    // Fixtures of the same setups, which follow each other, are capped together.
    const inSetups = (k: number): string => String(meta.fixtures[k].setups);
    meta.fixtures.forEach(({ start, count }, k) => {
      if (k > 0 && inSetups(k) === inSetups(k - 1)) bodies[bodies.length - 1][2] += count;
      else bodies.push(["a fixture", start, count, colourOf(meta, "fixture"), -1 - k]);
    });
    bodies.forEach(([name, first, count, colour, of], i) => {
      if (!count) return;
      const mine = (owner: Owner): boolean =>
        of >= 0 ? owner >= 0 && !meta.faces[owner].ignored : owner < 0 && inSetups(-1 - owner) === inSetups(-1 - of);
      if (!closed(drawn, mine)) {
        open.push(name);
        return;
      }
      const geometry = drawn.geometry(first, count);
      const counter = new Mesh(geometry, countingMaterial());
      counter.renderOrder = 1 + 0.1 * i;
      this.counters.push(counter);
      this.owners.push(of);
      const material = capMaterial(colour);
      material.stencilRef = 0;
      material.stencilFunc = NotEqualStencilFunc;
      material.stencilFail = material.stencilZFail = material.stencilZPass = ZeroStencilOp;
      const size = 2.2 * distance(low, high);
      const cap = new Mesh(new PlaneGeometry(size, size), material);
      cap.renderOrder = 1.05 + 0.1 * i;
      this.caps.push(cap);
    });
    stage.add(...this.counters, ...this.caps);
    this.note.textContent = open.length ? `${open.join(" and ")} is an open surface: it has no cap.` : "";
  }
}

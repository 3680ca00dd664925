// The clipping plane: across an axis of the part, with caps where it cuts closed bodies.

import { DoubleSide, Mesh, NotEqualStencilFunc, PlaneGeometry, Ray, Vector3, ZeroStencilOp } from "./three";
import { colourOf } from "./colours.ts";
import { button, coordinate, el } from "./dom.ts";
import type { Drawn, Owner } from "./mesh.ts";
import type { Vec } from "./meta.ts";
import { capMaterial, countingMaterial, shared } from "./shading.ts";
import type { Stage } from "./stage.ts";
import type { PageState } from "./state.ts";
import { axis, distance, mixed } from "./vectors.ts";

export class Clip {
  readonly root = el("div", { id: "clip", role: "group", "aria-label": "Clip" });
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

  constructor(private readonly state: PageState, private readonly stage: Stage) {
    const choices = [["", "Clip: off"], ["0", "across X"], ["1", "across Y"], ["2", "across Z"]];
    for (const [value, label] of choices) {
      this.axis.append(el("option", { value }, label));
    }
    this.axis.addEventListener("change", () => this.turn());
    this.slider.addEventListener("input", () => this.update());
    const flip = button("Flip", () => {
      this.sign = -this.sign;
      this.update();
    });
    this.root.append(this.axis, this.slider, this.text, flip, this.note);
    // A cut that was made for a hidden place ends with it.
    state.on("sample", () => this.release());
    state.on("there", () => this.stand());
    this.update();
  }

  /** Off, X, Y, Z and off again. */
  next(): void {
    this.axis.selectedIndex = (this.axis.selectedIndex + 1) % this.axis.options.length;
    this.turn();
    const where = `${this.axis.selectedOptions[0].text} at ${this.text.value}`;
    this.state.say(this.on ? `Clipped ${where}. ${this.note.textContent}` : "Clipping off");
  }

  /** Another plane: its cut faces the eye. */
  private turn(): void {
    this.own = false;
    if (this.on) this.sign = this.stage.table.frame().back[Number(this.axis.value)] < 0 ? -1 : 1;
    this.update();
  }

  /** Cut through a place of the surface that is hidden otherwise; the direction from which the cut is seen. */
  through(point: Vec, normal: Vec): Vec {
    const size = normal.map(Math.abs);
    // Along the normal and along the setup axis one would see the cut from its edge, or what is machined from below.
    const rank = size.map((x, k) => x + 0.9 * Math.abs(this.state.meta.setup.z[k]));
    const k = rank.indexOf(Math.min(...rank));
    const { low, high } = this.state.meta.part;
    const middle = (low[k] + high[k]) / 2;
    this.axis.value = String(k);
    this.slider.value = String((1000 * (point[k] - low[k])) / (high[k] - low[k] || 1));
    this.sign = point[k] < middle ? -1 : 1;
    this.own = true;
    this.update();
    return axis(k, this.sign);
  }

  private release(): void {
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
    const { low, high } = this.state.meta.part;
    for (const each of this.root.querySelectorAll<HTMLElement>("input, output, button, .hint")) each.hidden = !this.on;
    this.root.classList.toggle("on", this.on);
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
    this.stage.request();
  }

  /** Cap what is there in the setup that is shown. */
  private stand(): void {
    for (const meshes of [this.caps, this.counters]) {
      meshes.forEach((mesh, i) => (mesh.visible = this.on && this.state.drawn.solid(this.owners[i])));
    }
  }

  /** Turn a bit over, pixel by pixel, for each surface behind the plane: where their number is odd the plane lies in a body. */
  private build(): void {
    this.built = true;
    const { stage, state: { drawn, meta } } = this;
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

const POINTS = 400;
/** Share of the points within that may be told otherwise by one of the rays. */
const DOUBTFUL = 0.04;
const WAYS = [
  [0.437, 0.771, 0.463],
  [-0.623, 0.217, 0.751],
  [0.283, -0.859, -0.427],
].map(([x, y, z]) => new Vector3(x, y, z).normalize());

/**
 * Whether the triangles of some owners enclose something, so that a section through them has an inside: seen from many points,
 * the number of surfaces that a ray meets is odd in every direction or in none. Small cracks between faces do not matter.
 */
function closed(drawn: Drawn, wanted: (owner: Owner) => boolean): boolean {
  const { low, high } = drawn.meta.part;
  let [within, doubtful] = [0, 0];
  for (let i = 1; i <= POINTS; i++) {
    const at = [2, 3, 5].map((base, k) => low[k] + (high[k] - low[k]) * spread(i, base));
    const odd = WAYS.map((way) => {
      const hits = drawn.tree.raycast(new Ray(new Vector3(...at), way), DoubleSide);
      return hits.filter(({ face }) => face && wanted(drawn.owner[face.a])).length % 2;
    });
    const count = odd.reduce((sum, each) => sum + each, 0);
    within += count > 0 ? 1 : 0;
    doubtful += count > 0 && count < WAYS.length ? 1 : 0;
  }
  return doubtful <= Math.max(1, DOUBTFUL * within);
}

/** The i-th of evenly spread numbers between 0 and 1 (radical inverse). */
function spread(i: number, base: number): number {
  let [found, share] = [0, 1 / base];
  for (let rest = i; rest > 0; rest = Math.floor(rest / base)) {
    found += (rest % base) * share;
    share /= base;
  }
  return found;
}

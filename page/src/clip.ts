// The clipping plane: across an axis of the part, with caps where it cuts closed bodies.

import {
  AlwaysStencilFunc,
  BackSide,
  DecrementWrapStencilOp,
  FrontSide,
  IncrementWrapStencilOp,
  Mesh,
  NotEqualStencilFunc,
  PlaneGeometry,
  Vector3,
  ZeroStencilOp,
} from "three";
import type { App } from "./app.ts";
import { colourOf } from "./colours.ts";
import { button, el, figure } from "./dom.ts";
import type { Vec } from "./meta.ts";
import { capMaterial, countingMaterial, shared } from "./shading.ts";
import { distance, mixed } from "./vectors.ts";

/** Edges that may have no partner before a surface counts as open: a share of all. */
const OPEN = 0.01;

export class Clip {
  readonly root = el("fieldset", { id: "clip" });
  private readonly slider = el("input", { type: "range", min: 0, max: 1000, value: 500, "aria-label": "Place of the clipping plane" });
  private readonly axis = el("select", { "aria-label": "Clipping plane" });
  private readonly text = el("output", { class: "number" });
  private readonly note = el("span", { class: "hint" });
  private readonly caps: Mesh[] = [];
  private readonly counters: Mesh[] = [];
  private sign = 1;
  private built = false;

  constructor(private readonly app: App) {
    for (const [value, label] of [["", "off"], ["0", "across X"], ["1", "across Y"], ["2", "across Z"]]) {
      this.axis.append(el("option", { value }, label));
    }
    this.axis.addEventListener("change", () => this.update(true));
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
    this.update(true);
    this.app.say(this.on ? `Clipped ${this.axis.selectedOptions[0].text} at ${this.text.value}. ${this.note.textContent}` : "Clipping off");
  }

  private get on(): boolean {
    return this.axis.value !== "";
  }

  private update(told = false): void {
    const { low, high } = this.app.meta.part;
    for (const each of this.root.querySelectorAll<HTMLElement>("input, output, button, .hint")) each.hidden = !this.on;
    const plane = shared.plane.value;
    if (!this.on) {
      plane.set(0, 0, 0, 1);
    } else {
      if (!this.built) this.build();
      const k = Number(this.axis.value);
      const at = low[k] + ((high[k] - low[k]) * Number(this.slider.value)) / 1000;
      const normal: Vec = [0, 0, 0];
      normal[k] = this.sign;
      plane.set(...normal, this.sign * at);
      this.text.value = `${"XYZ"[k]} ${figure(at, 4)} mm`;
      const middle = mixed(low, 0.5, high, 0.5);
      middle[k] = at;
      for (const cap of this.caps) {
        cap.position.set(...middle);
        cap.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), new Vector3(...normal));
      }
    }
    for (const mesh of [...this.caps, ...this.counters]) mesh.visible = this.on;
    if (told) this.root.dataset.axis = this.axis.value;
    this.app.stage.request();
  }

  /** Count, pixel by pixel, the backs and fronts behind the plane: where they differ the plane lies in a body. */
  private build(): void {
    this.built = true;
    const { drawn, meta, stage } = this.app;
    const { low, high } = meta.part;
    const all = drawn.triangle.length / 3;
    const open: string[] = [];
    const bodies: [string, number, number, string][] = [
      ["the part", 0, drawn.ofFaces, "#8f8577"],
      ["a fixture", drawn.ofFaces, all - drawn.ofFaces, colourOf(meta, "fixture")],
    ];
    bodies.forEach(([name, first, count, colour], i) => {
      if (!count) return;
      if (!closed(drawn.position, drawn.triangle.subarray(3 * first, 3 * (first + count)), drawn.owner, meta.faces.map((f) => f.ignored))) {
        open.push(name);
        return;
      }
      const geometry = drawn.geometry(first, count);
      for (const [side, step] of [
        [BackSide, IncrementWrapStencilOp],
        [FrontSide, DecrementWrapStencilOp],
      ] as const) {
        const material = countingMaterial();
        material.side = side;
        material.stencilFunc = AlwaysStencilFunc;
        material.stencilFail = material.stencilZFail = material.stencilZPass = step;
        const mesh = new Mesh(geometry, material);
        mesh.renderOrder = 1 + 0.1 * i;
        this.counters.push(mesh);
      }
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

/** Whether every edge has a partner: vertices of different faces count as one where they lie at the same place. */
export function closed(position: Float32Array, triangle: Uint32Array, owner: Float32Array, ignored: boolean[]): boolean {
  const name = new Map<string, number>();
  const same = new Int32Array(position.length / 3).fill(-1);
  const vertex = (i: number): number => {
    if (same[i] < 0) {
      const key = `${position[3 * i]},${position[3 * i + 1]},${position[3 * i + 2]}`;
      let found = name.get(key);
      if (found === undefined) name.set(key, (found = name.size));
      same[i] = found;
    }
    return same[i];
  };
  const edges = new Map<number, number>();
  let count = 0;
  for (let t = 0; t < triangle.length; t += 3) {
    const of = owner[triangle[t]];
    if (of >= 0 && ignored[of]) continue;
    for (let k = 0; k < 3; k++) {
      const a = vertex(triangle[t + k]);
      const b = vertex(triangle[t + ((k + 1) % 3)]);
      if (a === b) continue;
      const key = Math.min(a, b) * 67108864 + Math.max(a, b);
      edges.set(key, (edges.get(key) ?? 0) + (a < b ? 1 : -1));
      count++;
    }
  }
  let alone = 0;
  for (const sum of edges.values()) if (sum !== 0) alone++;
  return alone <= OPEN * count;
}

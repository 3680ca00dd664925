// Mouse, fingers and wheel turn, shift and zoom a picture: three's own controls move a camera of theirs, and the turntable follows it.

import { MathUtils, OrbitControls, OrthographicCamera, TOUCH, MOUSE, Vector3 } from "./three";
import { type Aim, quiet, type Turntable, VIEWS } from "./camera.ts";
import { button, el } from "./dom.ts";
import type { Stage } from "./stage.ts";
import type { Vec } from "./meta.ts";
import { plus } from "./vectors.ts";

/** A press that moves less than this, pixels, is a click. */
const STILL = 4;
/** Turn by a pixel, degrees, and zoom by a notch of the wheel, in the unit of three's controls. */
const [TURN, WHEEL] = [0.45, 2.9];
/** Share of a movement by a finger that a frame takes up: what is left goes on when the finger has left. */
const INERTIA = 0.25;
/** Below this angle from a pole the view is along it; there the controls need a direction still, degrees. */
const POLE = 0.01;

/** What becomes of a pointer that does not turn the picture: places are -1 to 1 each way. */
export interface Told {
  hover: (x: number, y: number) => void;
  leave: () => void;
  choose: (x: number, y: number, event: PointerEvent) => void;
}

export function steer(stage: Stage, told: Told): void {
  const { canvas } = stage;
  const down = new Map<number, { x: number; y: number }>();
  let [still, asked] = [false, 0];
  new Hand(canvas, stage.table, down, () => still);
  canvas.addEventListener("pointerdown", (event) => {
    still = down.size === 0 && event.button === 0 && !event.shiftKey;
    down.set(event.pointerId, { x: event.clientX, y: event.clientY });
  });
  canvas.addEventListener("pointermove", (event) => {
    const from = down.get(event.pointerId);
    if (from) {
      still &&= Math.hypot(event.clientX - from.x, event.clientY - from.y) < STILL;
      return;
    }
    // Once a frame is enough for what lies under the pointer.
    cancelAnimationFrame(asked);
    asked = requestAnimationFrame(() => told.hover(...stage.place(event)));
  });
  const up = (event: PointerEvent): void => {
    if (down.delete(event.pointerId) && still && event.type === "pointerup") told.choose(...stage.place(event), event);
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointerleave", () => {
    cancelAnimationFrame(asked);
    told.leave();
  });
}

/** Buttons that zoom and fit, for who has no wheel. */
export function zoomButtons(table: () => Turntable): HTMLElement {
  const zoom = (sign: string, name: string, work: () => void): HTMLButtonElement =>
    button(sign, work, { title: name, "aria-label": name });
  return el(
    "div",
    { class: "zoom", role: "group", "aria-label": "Zoom" },
    zoom("+", "Zoom in (+)", () => table().fly({ half: table().zoomed(1.5) })),
    zoom("\u2212", "Zoom out (-)", () => table().fly({ half: table().zoomed(1 / 1.5) })),
    zoom("\u2922", "Fit the part (f)", () => table().fit()),
  );
}

/** A choice of standard views. */
export function viewSelect(table: () => Turntable): HTMLSelectElement {
  const select = el("select", { id: "views" }, el("option", { value: "" }, "choose"), el("option", { value: "f" }, "fit"));
  for (const [key, [name]] of Object.entries(VIEWS)) select.append(el("option", { value: key }, name));
  select.addEventListener("change", () => {
    const [, turn, rise] = VIEWS[select.value] ?? [];
    select.value = "";
    table().fit(turn, rise);
  });
  return select;
}

/**
 * What a key does to a picture, and whether it does anything: arrows turn and shift it where it has the focus, for elsewhere they scroll;
 * others zoom, fit, or choose a view.
 */
export function pictureKey(event: KeyboardEvent, table: Turntable, focused: boolean): boolean {
  const arrows: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
  const arrow = focused ? arrows[event.key] : undefined;
  if (arrow) {
    event.preventDefault();
    const [x, y] = arrow;
    if (event.ctrlKey) table.pan(-0.08 * x, 0.08 * y);
    else table.orbit(8 * x, 8 * y);
    return true;
  }
  if (event.ctrlKey) return false;
  const [, turn, rise] = VIEWS[event.key] ?? [];
  const zoom = { "+": 1.25, "=": 1.25, "-": 0.8 }[event.key];
  if (zoom) table.zoom(zoom);
  else if (turn !== undefined || event.key === "f") table.fit(turn, rise);
  else return false;
  return true;
}

/** A camera that three's controls move, and a turntable that goes with it. */
class Hand {
  private readonly camera = new OrthographicCamera();
  private readonly controls: OrbitControls;
  private from: Aim;
  private azimuth = 0;
  private last: Aim | null = null;
  private frame = 0;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly table: Turntable,
    /** What is pressed. */
    private readonly down: ReadonlyMap<number, unknown>,
    /** Whether a press may be a click still: then nothing moves. */
    private readonly waits: () => boolean,
  ) {
    this.from = table.aim;
    // The controls turn about what is up when they are made.
    this.camera.up.set(...table.z);
    // In capture, to be there before the controls.
    canvas.addEventListener("pointerdown", (event) => this.begins(event), { capture: true });
    canvas.addEventListener("wheel", () => this.wheels(), { capture: true, passive: true });
    const controls = (this.controls = new OrbitControls(this.camera, canvas));
    controls.zoomToCursor = true;
    controls.dampingFactor = INERTIA;
    controls.mouseButtons = { LEFT: MOUSE.ROTATE, MIDDLE: MOUSE.PAN, RIGHT: MOUSE.PAN };
    controls.touches = { ONE: TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN };
    canvas.addEventListener("wheel", () => this.follow(), { passive: true });
    // The controls listen at the document: the window hears of it later.
    window.addEventListener("pointermove", (event) => this.down.has(event.pointerId) && !this.waits() && this.follow());
  }

  private begins(event: PointerEvent): void {
    if (this.down.size > 0) return;
    this.stop();
    // Only fingers have inertia: a mouse points more exactly.
    this.controls.enableDamping = event.pointerType === "touch" && !quiet();
    this.controls.zoomSpeed = 1;
    this.put();
    if (this.controls.enableDamping) this.glide();
  }

  private wheels(): void {
    this.stop();
    this.controls.enableDamping = false;
    this.controls.zoomSpeed = WHEEL;
    this.put();
  }

  private stop(): void {
    cancelAnimationFrame(this.frame);
    if (this.frame) {
      // What is left of a movement is used up, and forgotten by `put`.
      this.controls.enableDamping = false;
      this.controls.update();
    }
    this.frame = 0;
  }

  /** Put the controls' camera where the turntable is. */
  private put(): void {
    const { table, camera, controls } = this;
    const aim = (this.from = table.aim);
    const { back } = table.frame({ ...aim, rise: MathUtils.clamp(aim.rise, POLE - 90, 90 - POLE) });
    const [least, most] = table.halves;
    controls.target.set(...aim.target);
    camera.position.set(...plus(aim.target, back, table.radius));
    [camera.top, camera.right] = [aim.half, aim.half * table.aspect];
    [camera.bottom, camera.left] = [-camera.top, -camera.right];
    [camera.near, camera.far, camera.zoom] = [-2 * table.radius, 4 * table.radius, 1];
    camera.updateProjectionMatrix();
    controls.minZoom = aim.half / most;
    controls.maxZoom = aim.half / least;
    controls.rotateSpeed = (TURN * this.canvas.clientHeight) / 360;
    controls.update();
    this.azimuth = controls.getAzimuthalAngle();
    this.last = aim;
  }

  /** Let the turntable go where the controls' camera is; false where nothing has moved. */
  private follow(): boolean {
    const { table, camera, controls, from } = this;
    if (table.aim !== this.last) return false;
    const turned = controls.getAzimuthalAngle() - this.azimuth;
    const turn = from.turn + MathUtils.radToDeg(Math.atan2(Math.sin(turned), Math.cos(turned)));
    const rise = 90 - MathUtils.radToDeg(controls.getPolarAngle());
    const pole = Math.abs(rise) > 90 - 2 * POLE;
    const target: Vec = [controls.target.x, controls.target.y, controls.target.z];
    const half = from.half / camera.zoom;
    const aim = { target, turn, rise: pole ? 90 * Math.sign(rise) : rise, half };
    const before = table.aim;
    const step = new Vector3(...target).distanceTo(new Vector3(...before.target)) / half;
    const news = Math.abs(aim.turn - before.turn) + Math.abs(aim.rise - before.rise) + Math.abs(half / before.half - 1) + step;
    if (news < 1e-4) return false;
    table.set(aim);
    this.last = table.aim;
    return true;
  }

  /** Take up what fingers have moved frame by frame, and go on with what is left when they are gone. */
  private glide(): void {
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      this.controls.update();
      const moved = !this.waits() && this.follow();
      if (moved || this.down.size > 0) this.glide();
    });
  }
}

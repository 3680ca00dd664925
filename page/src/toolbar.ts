// The line over the picture that says what it shows, with a button for each thing that it can show, and what else can be done with it.

import { modesOf } from "./colours.ts";
import { viewSelect } from "./controls.ts";
import { button, el, menu } from "./dom.ts";
import type { Picture } from "./picture.ts";
import { firstMode, modeOf, othersOf, PROCESS, titleOf } from "./plans.ts";
import { schemeSwitch } from "./scheme.ts";
import type { PageState } from "./state.ts";
import { LostViews } from "./views.ts";

/** What the surface shows, by mode: the process, the cutter shown alone, other plans. */
function subjects({ cutter, meta }: PageState): [string, string][] {
  const found: [string, string][] = meta.process ? [[PROCESS, "The process"]] : [];
  found.push(["verdict", `${cutter.name || cutter.id} alone`]);
  return [...found, ...othersOf(meta).map((plan): [string, string] => [modeOf(meta, plan), titleOf(plan)])];
}

function subjectSwitch(state: PageState): HTMLElement {
  const group = el("span", { class: "group", id: "show", role: "group", "aria-label": "Shown" });
  state.on("look", () => {
    const buttons = subjects(state).map(([mode, label]) =>
      button(label, () => state.setMode(mode), { title: "What the picture shows (o)", "aria-pressed": String(state.mode === mode), "data-mode": mode }),
    );
    const at = document.activeElement?.closest<HTMLElement>("#show button")?.dataset.mode;
    group.replaceChildren(el("span", {}, "Shown:"), ...buttons);
    if (at) buttons.find((each) => each.dataset.mode === at)?.focus();
  });
  return group;
}

/** Show the next of these. */
export function nextSubject(state: PageState): void {
  const all = subjects(state);
  const [mode, label] = all[(all.findIndex(([each]) => each === state.mode) + 1) % all.length];
  state.setMode(mode);
  state.say(label);
}

function colouring(state: PageState): HTMLSelectElement {
  const select = el("select", { id: "colouring" }, ...modesOf(state.meta).map(({ key, label }) => el("option", { value: key }, label)));
  select.addEventListener("change", () => state.setMode(select.value));
  state.on("look", () => (select.value = state.mode));
  return select;
}

/** The picture alone: it takes the whole window, and the whole screen where the browser lets it. */
export class Alone {
  readonly button = button("Full picture", () => this.toggle(), {
    id: "alone", "aria-pressed": "false", title: "The picture in the whole window (w, Escape leaves)",
  });

  constructor(private readonly say: (text: string) => void) {
    // The browser's own ways out of its full screen.
    document.addEventListener("fullscreenchange", () => {
      if (!document.fullscreenElement && this.on) this.set(false);
    });
  }

  get on(): boolean {
    return document.documentElement.classList.contains("alone");
  }

  toggle(): void {
    const wanted = !this.on;
    this.set(wanted);
    // Within another page it may be forbidden: the window is enough.
    if (wanted) void document.documentElement.requestFullscreen?.().catch(() => undefined);
    else if (document.fullscreenElement) void document.exitFullscreen();
  }

  private set(wanted: boolean): void {
    document.documentElement.classList.toggle("alone", wanted);
    this.button.setAttribute("aria-pressed", String(wanted));
    this.say(wanted ? "The picture alone: Escape or w brings the tables back" : "The tables are back");
  }
}

/** A button to the next side that shows what stays of the process, or what the cutter shown loses. */
function lostButton(picture: Picture): HTMLButtonElement {
  const { state } = picture;
  const sides = new Map<string, LostViews>();
  const made = button("What stays", () => {
    const subject = state.mode === firstMode(state.meta) ? state.mode : state.cutter.id;
    const found = sides.get(subject) ?? new LostViews(picture);
    sides.set(subject, found);
    found.next();
    made.textContent = found.views.length ? `What stays, ${found.at + 1} of ${found.views.length}` : "Nothing stays";
  }, { id: "stays", title: "Look at what stays, side by side (l)" });
  return made;
}

/** The switches of the tool: whether it is shown, and whether one sees through it. */
export function toolSwitches({ stage, state, tool }: Picture): Record<"shown" | "glass", HTMLButtonElement> {
  const flip = (label: string, title: string, work: () => boolean): HTMLButtonElement => {
    const made = button(label, () => made.setAttribute("aria-pressed", String(work())), { "aria-pressed": "true", title });
    return made;
  };
  return {
    shown: flip("Tool", "Show or hide the tool (t)", () => {
      state.showTool(!state.toolShown);
      return state.toolShown;
    }),
    glass: flip("See through", "See through the tool (g)", () => {
      tool.seeThrough(!tool.transparent);
      stage.request();
      return tool.transparent;
    }),
  };
}

export interface Toolbar {
  root: HTMLElement;
  lost: HTMLButtonElement;
}

/** One row: what is shown, what stays, and what is asked for less often behind "More". */
export function toolbar(picture: Picture, alone: Alone, help: HTMLDialogElement, recolour: () => void, more: HTMLElement[]): Toolbar {
  const { eyes, stage, state } = picture;
  const lost = lostButton(picture);
  const root = el(
    "div",
    { id: "toolbar", role: "toolbar", "aria-label": "Picture" },
    subjectSwitch(state),
    lost,
    button("Fit", () => stage.table.fit(), { title: "Fit the part into the picture (f)" }),
    eyes.root,
    alone.button,
    menu(
      "more", "More", "Colours, views, measuring, a link",
      el("label", {}, "Colour by ", colouring(state)), el("label", {}, "View ", viewSelect(() => stage.table)), ...more, schemeSwitch(recolour),
    ),
    button("?", () => help.showModal(), { title: "Mouse and keys (?)", "aria-label": "Help: mouse and keys" }),
  );
  return { root, lost };
}

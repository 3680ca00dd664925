// The review page: the data are read, the picture is made, the tables come alive.

import { Alone } from "./alone.ts";
import { App } from "./app.ts";
import { VIEWS } from "./camera.ts";
import { Clip } from "./clip.ts";
import { zoomButtons } from "./controls.ts";
import { colourOf, modesOf } from "./colours.ts";
import { readArrays, readMeta } from "./decode.ts";
import { button, el } from "./dom.ts";
import { Borders } from "./edges.ts";
import { Eyes } from "./eyes.ts";
import { firstView, LostViews } from "./first_view.ts";
import { helpDialog, listenKeys } from "./keys.ts";
import { Inset } from "./inset.ts";
import { legend } from "./legend.ts";
import { Links } from "./links.ts";
import { enhanceCutters, FaceTable, SpotList } from "./lists.ts";
import { Marks } from "./marks.ts";
import { Measure } from "./measure.ts";
import { Notes } from "./notes.ts";
import { firstMode, OperationTables, subjectSwitch } from "./operations.ts";
import { Drawn } from "./mesh.ts";
import { Outline } from "./outline.ts";
import { PartView } from "./part.ts";
import { Picker } from "./pick.ts";
import { listen } from "./pointer.ts";
import { PosturePanel } from "./posture_map.ts";
import { Stills } from "./print.ts";
import { copyTyped, ProcessTable } from "./process.ts";
import { Samples } from "./samples.ts";
import { Scale } from "./scale.ts";
import { partMaterial } from "./shading.ts";
import { schemeSwitch } from "./scheme.ts";
import { Selection } from "./selection.ts";
import { Stage } from "./stage.ts";
import { ToolView } from "./tool.ts";

const NONE = new Float32Array();

async function start(): Promise<void> {
  const viewer = document.getElementById("viewer");
  if (!viewer) return;
  performance.mark("start");
  // What "Save copy" writes: the page before anything in it is changed. Texts are shared, not copied.
  const pristine = document.documentElement.cloneNode(true) as HTMLElement;
  document.documentElement.classList.add("app");
  const status = el("p", { id: "status", role: "status" });
  const under = el("p", { id: "under" });
  const frame = el("div", { id: "frame" });
  const canvas = el("canvas", {
    id: "picture",
    tabindex: 0,
    role: "application",
    "aria-label": "The part in 3D. Arrow keys turn it, Enter selects the sample in the middle, ? shows all keys.",
  });
  frame.append(canvas);
  viewer.append(frame, status);
  const say = (text: string): void => {
    status.textContent = text;
  };

  const meta = readMeta();
  // They are inflated while the browser makes ready to draw.
  const reading = readArrays(meta);
  reading.catch(() => undefined);
  let stage: Stage;
  let drawn: Drawn | null = null;
  try {
    stage = new Stage(canvas, meta, () => drawn?.shownVertices ?? NONE);
  } catch {
    frame.remove();
    viewer.classList.add("without");
    // Without a picture there is nothing that the tables would have to stand beside.
    document.documentElement.classList.remove("app");
    say("This browser shows no 3D here (WebGL is missing or switched off). The tables say all that the picture would.");
    document.documentElement.dataset.ready = "without";
    return;
  }
  const material = partMaterial(colourOf(meta, "check"), colourOf(meta, "fixture"));
  stage.warm(material);
  const arrays = await reading;
  performance.mark("decoded");
  const samples = new Samples(meta, arrays);
  drawn = new Drawn(meta, arrays);
  const part = new PartView(drawn, arrays, material);
  const tool = new ToolView();
  stage.add(part.group, tool.group);
  const app = new App(meta, arrays, samples, drawn, stage, part, tool, new Picker(stage, drawn, part), say);

  let lines: Borders | null = null;
  app.eyes = new Eyes(app, () => {
    part.stand();
    lines?.look();
    app.clip?.stand();
    stage.request();
  });
  app.on("setup", () => lines?.look());
  app.outline = new Outline(stage, drawn);
  const inset = new Inset(app);
  const scale = new Scale(app);
  const marks = new Marks(app);
  const panel = new PosturePanel(app);
  const measure = new Measure(app, marks);
  const clip = (app.clip = new Clip(app));
  const help = helpDialog();
  const stills = new Stills(app);
  const selection = new Selection(app);
  const notes = new Notes(app, pristine);
  const links = new Links(app);
  panel.tools.append(button("Select face", () => selection.toggle(app.faceShown()), { title: "Select the face of this sample (s)" }), notes.here);
  document.querySelector("#summary .first")?.append(
    el("div", { class: "tools", id: "page-tools" }, ...notes.buttons()),
  );
  const alone = new Alone(say);
  const sides = new Map<string, LostViews>();
  /** Sides that show what stays of the process, or what the cutter shown loses. */
  const lost = (): LostViews => {
    const subject = app.mode === firstMode(meta) ? app.mode : app.cutter.id;
    const found = sides.get(subject) ?? new LostViews(app);
    sides.set(subject, found);
    return found;
  };
  const stays = button("What stays", () => nextLost(), { id: "stays", title: "Look at what stays, side by side (l)" });
  const nextLost = (): void => {
    const found = lost();
    found.next();
    stays.textContent = found.views.length ? `What stays, ${found.at + 1} of ${found.views.length}` : "Nothing stays";
  };
  const glass = button("See through", () => setGlass(), { "aria-pressed": "true", class: "of-tool", title: "See through the tool (g)" });
  const setGlass = (): void => {
    tool.seeThrough(!tool.transparent);
    glass.setAttribute("aria-pressed", String(tool.transparent));
    stage.request();
  };
  const shown = button("Tool", () => setTool(), { "aria-pressed": "true", class: "of-tool", title: "Show or hide the tool (t)" });
  const setTool = (): void => {
    app.showTool(!app.toolShown);
    shown.setAttribute("aria-pressed", String(app.toolShown));
  };
  const toolbar = el(
    "div",
    { id: "toolbar", role: "toolbar", "aria-label": "Picture" },
    subjectSwitch(app),
    stays,
    button("Fit", () => stage.table.fit(), { title: "Fit the part into the picture (f)" }),
    el("label", {}, "View ", views(app)),
    el("label", {}, "Colour by ", colouring(app)),
    el("span", { class: "group" }, shown, glass, measure.root),
    app.eyes.root,
    alone.button,
    links.button,
    button("?", () => help.showModal(), { title: "Mouse and keys (?)", "aria-label": "Help: mouse and keys" }),
    clip.root,
    schemeSwitch(() => panel.draw()),
  );
  frame.append(marks.root as unknown as Node, scale.root as unknown as Node, inset.root, measure.output, under, zoomButtons(() => stage.table));
  viewer.append(legend(app), selection.root);
  viewer.prepend(toolbar);
  viewer.append(panel.root);
  viewer.append(stills.root, help);
  app.repaint();
  stage.begin(() => firstView(app));
  performance.mark("drawn");

  listen(app, measure, selection, (text) => {
    under.textContent = text;
  });
  enhanceCutters(app);
  const spots = new SpotList(app);
  new FaceTable(app);
  selection.tabled();
  new OperationTables(app);
  if (meta.process) new ProcessTable(app, meta.process);
  copyTyped(say);
  listenKeys(app, { spots, clip, measure, help, selection, alone, lost: nextLost, link: () => links.button.click(), glass: setGlass, tool: setTool });
  // The tree over the triangles is what a click needs: once it is there the page answers.
  void app.drawn.tree;
  links.follow();
  performance.mark("interactive");
  setTimeout(() => {
    lines = new Borders(app.drawn);
    stage.add(lines.lines);
    performance.mark("borders");
    stage.request();
  }, 0);
  document.documentElement.dataset.ready = "yes";
  // For scripts that ask the page: tests, and people at the console.
  Object.assign(window, { review: app });
}

function colouring(app: App): HTMLSelectElement {
  const select = el("select", { id: "colouring" });
  const fill = (): void => {
    const modes = modesOf(app.meta);
    if (!modes.some((each) => each.key === app.mode)) app.mode = firstMode(app.meta);
    select.replaceChildren(...modes.map(({ key, label }) => el("option", { value: key, selected: key === app.mode }, label)));
  };
  select.addEventListener("change", () => app.setMode(select.value));
  app.on("cutter", fill);
  app.on("look", () => {
    select.value = app.mode;
  });
  fill();
  return select;
}

function views(app: App): HTMLSelectElement {
  const select = el("select", { id: "views" }, el("option", { value: "" }, "choose"));
  for (const [key, [name]] of Object.entries(VIEWS)) select.append(el("option", { value: key }, name));
  select.addEventListener("change", () => {
    const [, turn, rise] = VIEWS[select.value] ?? [];
    select.value = "";
    app.stage.table.fit(turn, rise);
  });
  return select;
}

start().catch((error: unknown) => {
  const status = document.getElementById("status");
  const text = error instanceof Error ? error.message : String(error);
  if (status) status.textContent = `The picture cannot be shown: ${text}. The tables say all that it would.`;
  document.documentElement.dataset.ready = "failed";
  console.error(error);
});

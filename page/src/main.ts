// The review page: the data are read, the picture is made, the tables come alive.

import { zoomButtons } from "./controls.ts";
import { colourOf } from "./colours.ts";
import { readArrays, readMeta } from "./decode.ts";
import { button, copyButton, el } from "./dom.ts";
import { helpDialog, listenKeys, listenPointer } from "./input.ts";
import { legend } from "./legend.ts";
import { Links } from "./links.ts";
import { enhanceCutters, FaceTable, Selection, SpotList } from "./lists.ts";
import { Notes } from "./notes.ts";
import { Inset, Marks, Measure, Scale } from "./over.ts";
import { Picture } from "./picture.ts";
import { PosturePanel } from "./posture_map.ts";
import { Stills } from "./print.ts";
import { OperationTables, ProcessTable } from "./process.ts";
import { partMaterial } from "./shading.ts";
import { Stage } from "./stage.ts";
import { PageState } from "./state.ts";
import { Alone, toolbar, toolSwitches } from "./toolbar.ts";
import { firstView } from "./views.ts";

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

  const meta = readMeta();
  // They are inflated while the browser makes ready to draw.
  const reading = readArrays(meta);
  reading.catch(() => undefined);
  let stage: Stage;
  let state: PageState | null = null;
  try {
    stage = new Stage(canvas, meta, () => state?.drawn.shownVertices ?? NONE);
  } catch {
    frame.remove();
    viewer.classList.add("without");
    // Without a picture there is nothing that the tables would have to stand beside.
    document.documentElement.classList.remove("app");
    status.textContent = "This browser shows no 3D here (WebGL is missing or switched off). The tables say all that the picture would.";
    document.documentElement.dataset.ready = "without";
    return;
  }
  const material = partMaterial(colourOf(meta, "check"), colourOf(meta, "fixture"));
  stage.warm(material);
  const arrays = await reading;
  performance.mark("decoded");
  state = new PageState(meta, arrays);
  const { say } = state;
  state.on("said", () => (status.textContent = state.said));
  const picture = new Picture(state, stage, material);
  const inset = new Inset(state, stage);
  const scale = new Scale(stage);
  const marks = new Marks(state, stage);
  const panel = new PosturePanel(state);
  // With a panel, or without one, the picture has another room: views are chosen for it.
  state.on("sample", () => stage.refit());
  const measure = new Measure(state, marks, () => stage.request());
  const help = helpDialog();
  const stills = new Stills(state, stage);
  const selection = new Selection(state, stage);
  const notes = new Notes(picture, pristine);
  const links = new Links(picture);
  const alone = new Alone(say);
  const { shown, glass } = toolSwitches(picture);
  panel.tools.append(
    button("Select face", () => selection.toggle(state.faceShown()), { title: "Select the face of this sample (s)" }),
    notes.here, shown, glass,
  );
  document.querySelector("#summary .first")?.append(el("div", { class: "tools", id: "page-tools" }, ...notes.buttons()));
  const bar = toolbar(picture, alone, help, () => panel.draw(), [measure.root, links.button]);
  const svgs = [marks.root, scale.root] as unknown as Node[];
  frame.append(...svgs, inset.root, measure.output, under, picture.clip.root, zoomButtons(() => stage.table));
  viewer.prepend(bar.root);
  viewer.append(legend(state), selection.root, panel.root, stills.root, help);
  state.repaint();
  stage.begin(() => firstView(picture));
  performance.mark("drawn");

  listenPointer(picture, measure, selection, (text) => (under.textContent = text));
  enhanceCutters(state);
  const spots = new SpotList(picture);
  new FaceTable(picture);
  selection.tabled();
  new OperationTables(picture);
  if (meta.process) new ProcessTable(picture, meta.process);
  // What one would type is copied by a button: nobody types on the page.
  for (const place of document.querySelectorAll<HTMLElement>("[data-typed]")) {
    place.append(copyButton("Copy options", () => place.dataset.typed!, say, "Copy options: what is added to the command for this"));
  }
  const pressed = { lost: bar.lost, link: links.button, glass, tool: shown };
  listenKeys(picture, { spots, measure, help, selection, alone, pressed });
  // The tree over the triangles is what a click needs: once it is there the page answers.
  void state.drawn.tree;
  links.follow();
  performance.mark("interactive");
  setTimeout(() => {
    picture.border();
    performance.mark("borders");
  }, 0);
  document.documentElement.dataset.ready = "yes";
  // For scripts that ask the page: tests, and people at the console.
  const { part, picker, tool } = picture;
  Object.assign(window, { review: Object.assign(state, { stage, part, picker, tool }) });
}

start().catch((error: unknown) => {
  const status = document.getElementById("status");
  const text = error instanceof Error ? error.message : String(error);
  if (status) status.textContent = `The picture cannot be shown: ${text}. The tables say all that it would.`;
  document.documentElement.dataset.ready = "failed";
  console.error(error);
});

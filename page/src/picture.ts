// The picture of what is shown: the part among what holds it, the tool, the clipping plane, and what lies under a place.

import type { ShaderMaterial } from "./three";
import { Clip } from "./clip.ts";
import { Eyes } from "./eyes.ts";
import type { Owner } from "./mesh.ts";
import { Borders, Outline, PartView } from "./part.ts";
import { Picker } from "./pick.ts";
import type { Stage } from "./stage.ts";
import type { PageState } from "./state.ts";
import { ToolView } from "./tool.ts";

export class Picture {
  readonly part: PartView;
  readonly tool = new ToolView();
  readonly picker: Picker;
  readonly clip: Clip;
  readonly eyes: Eyes;
  /** Whether the last look at a sample was a close one. */
  close = false;
  private readonly outline: Outline;
  private borders: Borders | null = null;
  private hot: Owner | null = null;

  constructor(readonly state: PageState, readonly stage: Stage, material: ShaderMaterial) {
    const { arrays, drawn } = state;
    this.part = new PartView(drawn, arrays, material);
    stage.add(this.part.group, this.tool.group);
    this.picker = new Picker(stage, drawn, this.part);
    this.clip = new Clip(state, stage);
    this.eyes = new Eyes(state);
    this.outline = new Outline(stage, drawn);
    const paint = (): void => {
      this.part.paint(state.look, state.lifted);
      stage.request();
    };
    state.on("look", paint);
    state.on("lift", paint);
    state.on("there", () => {
      this.part.stand();
      this.borders?.look();
      stage.request();
    });
    state.on("posture", () => {
      const placed = state.toolShown ? state.placed() : null;
      if (placed) this.tool.show(state.cutter, placed);
      else this.tool.hide();
      this.light();
    });
    state.on("hot", () => {
      if ((state.lit ? state.hot : null) !== this.hot) this.light();
    });
  }

  /** Draw the borders of faces, too: they take a moment. */
  border(): void {
    this.borders = new Borders(this.state.drawn);
    this.stage.add(this.borders.lines);
    this.stage.request();
  }

  private light(): void {
    const { hot, lit, meta, sample } = this.state;
    const way = this.state.inTheWay()?.owner ?? null;
    // The face of the sample itself keeps its verdicts in view: what is in the way of it there has a mark.
    const own = way !== null && sample !== null && meta.faces[way]?.number === sample.face;
    this.hot = lit ? hot : null;
    this.part.light(this.hot, own ? null : way);
    this.outline.show(way);
    this.stage.request();
  }
}

// The picture alone: it takes the whole window, and the whole screen where the browser lets it.

import { button } from "./dom.ts";

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

// Light or dark: as the system says, or as chosen on the page. The style sheet has the dark colours in one block with a condition.

import { el } from "./dom.ts";

const KEPT = "plan-cutters-scheme";
const CONDITION = "screen and (prefers-color-scheme: dark)";
const MEDIA: Record<string, string> = { auto: CONDITION, light: "not all", dark: "screen" };

export function schemeSwitch(changed: () => void): HTMLElement {
  const select = el(
    "select",
    { id: "scheme" },
    el("option", { value: "auto" }, "as the system"),
    el("option", { value: "light" }, "light"),
    el("option", { value: "dark" }, "dark"),
  );
  const rule = darkRule();
  const set = (): void => {
    if (rule) rule.media.mediaText = MEDIA[select.value];
    changed();
  };
  select.value = kept();
  if (select.value !== "auto") set();
  select.addEventListener("change", () => {
    set();
    try {
      localStorage.setItem(KEPT, select.value);
    } catch {
      // Without a store the choice holds while the page is open.
    }
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
  return el("label", {}, "Colours ", select);
}

function darkRule(): CSSMediaRule | null {
  for (const sheet of document.styleSheets) {
    for (const rule of sheet.cssRules) {
      if (rule instanceof CSSMediaRule && rule.media.mediaText.includes("prefers-color-scheme")) return rule;
    }
  }
  return null;
}

function kept(): string {
  try {
    const found = localStorage.getItem(KEPT) ?? "";
    return found in MEDIA ? found : "auto";
  } catch {
    return "auto";
  }
}

/** A colour of the style sheet, for what is drawn on a canvas. */
export const styled = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

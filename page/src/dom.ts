// Small words for making elements. Styles are set by the style sheet, never by attributes.

import { ALL_BUT, HARDLY_ANY, ROUNDING } from "./codes.ts";

type Child = Node | string | null;
type Attributes = Record<string, string | number | boolean | null>;

function fill(element: Element, attributes: Attributes, children: Child[]): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === false) continue;
    element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children.filter((child): child is Node | string => child !== null));
}

export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  fill(element, attributes, children);
  return element;
}

export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): SVGElementTagNameMap[K] {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  fill(element, attributes, children);
  return element;
}

export function button(label: string, work: () => void, attributes: Attributes = {}): HTMLButtonElement {
  const made = el("button", { type: "button", ...attributes }, label);
  made.addEventListener("click", work);
  return made;
}

/** A length or angle in as few figures as are of use, without an exponent. */
export function figure(value: number, digits = 3): string {
  if (!Number.isFinite(value)) return "unknown";
  if (Math.abs(value) < ROUNDING) return "0";
  const rounded = Number(value.toPrecision(Math.max(digits, Math.ceil(Math.log10(Math.abs(value) + 1)))));
  return rounded.toLocaleString("en", { useGrouping: false, maximumFractionDigits: 12 });
}

/** A coordinate: to a thousandth of a millimetre, for what is less is the rounding of what is drawn. */
export function coordinate(value: number, digits = 4): string {
  return figure(Number(value.toFixed(3)), digits);
}

/** An angle to a tenth of a degree, 0 up to 360: what rounds to a whole turn is none. */
export function degrees(value: number): string {
  const tenths = Number(value.toFixed(1));
  return String(tenths === 360 || Object.is(tenths, -0) ? 0 : tenths);
}

/** A share in percent: 100 only where it is the whole, and 0 only where there is nothing of it. */
export function percent(share: number): string {
  if (share <= 0 || share >= 1) return share >= 1 ? "100 %" : "0 %";
  const text = (100 * share).toFixed(1);
  return text === "0.0" ? HARDLY_ANY : text === "100.0" ? ALL_BUT : `${Number(text)} %`;
}

/** A button that copies a text; the status line says what was copied, or the text itself where nothing can be. */
export function copyButton(label: string, text: () => string, say: (words: string) => void, named: string): HTMLButtonElement {
  return button(
    label,
    async () => {
      const copied = text();
      say((await copy(copied)) ? `Copied: ${copied}` : `This browser does not let the page copy. Copy it by hand: ${copied}`);
    },
    { class: "copy", title: named, "aria-label": named },
  );
}

async function copy(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    // An older browser, or a page that is not trusted: by a selection.
    const box = el("textarea", { class: "aside", "aria-hidden": "true", tabindex: -1 });
    const focused = document.activeElement as HTMLElement | null;
    box.value = text;
    document.body.append(box);
    box.select();
    const copied = document.execCommand("copy");
    box.remove();
    focused?.focus();
    return copied;
  }
}

/** What opens at a press and closes at Escape, or at a press elsewhere. */
export function menu(id: string, label: string, title: string, ...children: Child[]): HTMLDetailsElement {
  const made = el("details", { id, class: "menu" }, el("summary", { title }, label), el("ul", {}, ...children.map((child) => child && el("li", {}, child))));
  made.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !made.open) return;
    event.preventDefault();
    made.open = false;
    made.querySelector("summary")!.focus();
  });
  document.addEventListener("pointerdown", (event) => {
    if (!made.contains(event.target as Node)) made.open = false;
  });
  return made;
}

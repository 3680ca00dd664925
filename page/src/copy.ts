// Texts that people take with them to other programs.

import { button, el } from "./dom.ts";

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

// Tables that are sorted by their heads: rows that say more of the one above stay with it, and what is shown stays on top.

import { el } from "./dom.ts";

/** Turn what an element says into a button in it. */
export function press(host: HTMLElement, work: () => void): HTMLButtonElement {
  const made = document.createElement("button");
  made.type = "button";
  made.className = "text";
  made.append(...host.childNodes);
  host.append(made);
  made.addEventListener("click", work);
  return made;
}

/** The row below that says more of the same thing. */
export function moreOf(row: HTMLElement): HTMLElement | null {
  const next = row.nextElementSibling as HTMLElement | null;
  return next?.classList.contains("more") ? next : null;
}

/** Heads of columns become buttons that sort by them; `first` says which row stays on top. */
export function sortable(table: HTMLTableElement, first: (row: HTMLElement) => boolean = () => false): void {
  const heads = [...(table.tHead?.rows[0]?.cells ?? [])].filter((head) => head.textContent!.trim() !== "");
  const body = table.tBodies[0];
  if (!body) return;
  for (const head of heads) {
    press(head, () => {
      const up = head.getAttribute("aria-sort") !== "ascending";
      for (const other of heads) other.removeAttribute("aria-sort");
      head.setAttribute("aria-sort", up ? "ascending" : "descending");
      const k = head.cellIndex;
      const rows = [...body.rows].filter((row) => !row.classList.contains("more"));
      const sorted = rows.map((row) => ({ row, more: moreOf(row) }));
      sorted.sort((a, b) => Number(first(b.row)) - Number(first(a.row)) || (up ? 1 : -1) * compared(a.row.cells[k], b.row.cells[k]));
      body.append(...sorted.flatMap(({ row, more }) => (more ? [row, more] : [row])));
    });
  }
}

/** Order of two cells: by their exact numbers where they have some, or begin with one (`F12`, `<0.1 %`), else by their words. */
function compared(a: HTMLElement | undefined, b: HTMLElement | undefined): number {
  const [x, y] = [a, b].map((cell) => cell?.dataset.sort ?? cell?.textContent?.trim() ?? "");
  const [u, v] = [x, y].map((text) => Number.parseFloat(text.replace(/^[F<>\s]+|,/g, "")));
  if (Number.isFinite(u) && Number.isFinite(v)) return u - v;
  return x.localeCompare(y, "en", { numeric: true });
}

/** Whether a row, or the one below that says more of it, has a text; letters of both cases are one. */
export function holds(row: HTMLElement, wanted: string): boolean {
  return `${row.textContent} ${moreOf(row)?.textContent ?? ""}`.toLowerCase().includes(wanted);
}

/** A box above a table that filters its rows; `show` hides those that lack a text and counts the others. */
export function filterTools(what: string, placeholder: string, all: number, show: (wanted: string) => number, ...more: HTMLInputElement[]): HTMLElement {
  const box = el("input", { type: "search", "aria-label": `Show ${what} that contain`, placeholder });
  const count = el("span", { class: "hint", "aria-live": "polite" });
  const tools = el("p", { class: "tools" }, box, count);
  tools.addEventListener("input", () => {
    const wanted = box.value.trim().toLowerCase();
    const shown = show(wanted);
    count.textContent = wanted || more.some(({ checked }) => checked) ? `${shown} of ${all}` : "";
  });
  return tools;
}

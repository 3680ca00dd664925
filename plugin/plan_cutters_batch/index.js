// Rows are sorted, filtered and shown a few hundred at a time: ten thousand of them at once would take seconds to lay out.
"use strict";
document.documentElement.classList.add("js");
document.addEventListener("DOMContentLoaded", () => {
  const STEP = 200;
  const body = document.querySelector("#parts tbody"), more = document.getElementById("more");
  const filter = document.getElementById("filter"), status = document.getElementById("status");
  const heads = [...document.querySelectorAll("#parts th[data-sort]")], only = [...document.querySelectorAll("[data-only]")];
  const words = new Intl.Collator(undefined, { numeric: true, sensitivity: "base" });
  const number = new Intl.NumberFormat("en");
  let rows = [...body.rows], found = rows, room = STEP, texts = null;

  function show() {
    found.forEach((row, k) => row.classList.toggle("in", k < room));
    more.hidden = found.length <= room;
    const shown = Math.min(room, found.length);
    status.textContent = `${number.format(shown)} of ${number.format(rows.length)} parts are shown`
      + (found.length > shown && found.length < rows.length ? `; ${number.format(found.length)} match` : "") + ".";
  }

  function sift() {
    texts ??= new Map(rows.map(row => [row, row.textContent.toLowerCase()]));
    const asked = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const kinds = only.filter(each => each.ariaPressed === "true").map(each => each.dataset.only);
    found = [];
    for (const row of rows) {
      const mine = (!kinds.length || kinds.includes(row.dataset.is)) && asked.every(word => texts.get(row).includes(word));
      row.classList.toggle("out", !mine);
      if (mine) found.push(row);
      else row.classList.remove("in");
    }
    room = STEP;
    show();
  }

  // What is not known comes last, whichever way the rest is sorted; equals keep their order.
  function sort(head) {
    const down = head.ariaSort === "ascending", column = head.cellIndex, numbers = head.dataset.sort === "number";
    const values = new Map(rows.map(row => {
      const cell = row.cells[column], text = cell.textContent;
      return [row, numbers ? (cell.dataset.v === "" ? null : Number(cell.dataset.v)) : text === "–" ? null : text];
    }));
    const way = down ? -1 : 1;
    rows.sort((a, b) => {
      const x = values.get(a), y = values.get(b);
      if (x === null || y === null) return (x === null) - (y === null);
      return way * (numbers ? x - y : words.compare(x, y));
    });
    for (const each of heads) each.removeAttribute("aria-sort");
    head.ariaSort = down ? "descending" : "ascending";
    body.append(...rows);
    const chosen = new Set(found);
    found = rows.filter(row => chosen.has(row));
    for (const row of rows) row.classList.remove("in");
    show();
  }

  for (const head of heads) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = head.textContent;
    button.addEventListener("click", () => sort(head));
    head.replaceChildren(button);
  }
  for (const each of only) {
    each.disabled = false;
    each.addEventListener("click", () => {
      each.ariaPressed = each.ariaPressed === "true" ? "false" : "true";
      sift();
    });
  }
  filter.disabled = false;
  filter.addEventListener("input", sift);
  more.addEventListener("click", () => {
    const next = found[room];
    room += STEP;
    show();
    // Whoever moves by keys goes on where the new rows begin.
    next.tabIndex = -1;
    next.focus({ preventScroll: true });
  });
  show();
  document.documentElement.dataset.ready = "yes";
});

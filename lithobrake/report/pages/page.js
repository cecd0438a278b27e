"use strict";
// An element with these properties and what is inside it.
function element(name, settings = {}, ...inside) {
  const made = Object.assign(document.createElement(name), settings);
  made.append(...inside);
  return made;
}

// Paper cannot be unfolded: warnings stand on it in full, and what else is folded does not.
addEventListener("beforeprint", () => {
  for (const part of document.querySelectorAll(".warnings:not([open])")) { part.open = true; part.dataset.folded = ""; }
});
addEventListener("afterprint", () => {
  for (const part of document.querySelectorAll("[data-folded]")) { part.open = false; delete part.dataset.folded; }
});

// The number that a cell begins with, powers of ten and gaps between thousands included; NaN where it begins with none.
function cellNumber(text) {
  const raised = "⁰¹²³⁴⁵⁶⁷⁸⁹", found = text.replace(/[\u2212\u2011]/g, "-").replace(/(\d)[ \u00a0](?=\d{3}\b)/g, "$1")
    .match(/^\s*([-+]?\d[\d.]*)(?: × 10(⁻?)([⁰¹²³⁴⁵⁶⁷⁸⁹]+))?/);
  if (!found) return NaN;
  const power = found[3] ? Number([...found[3]].map((one) => raised.indexOf(one)).join("")) : 0;
  return Number(found[1]) * 10 ** (found[2] ? -power : power);
}

// Rows by a column: numbers before words, a second time the other way round, a third time as they came.
function sortRows(heading) {
  const table = heading.closest("table"), body = table.tBodies[0], column = heading.cellIndex;
  const order = { ascending: "descending", descending: undefined }, was = heading.getAttribute("aria-sort");
  const now = was ? order[was] : "ascending", sign = now === "descending" ? -1 : 1;
  for (const one of table.tHead.rows[0].cells) one.removeAttribute("aria-sort");
  if (now) heading.setAttribute("aria-sort", now);
  const keyed = [...body.rows].map((row, place) => {
    row.dataset.place ??= place;
    const text = row.cells[column].textContent, number = cellNumber(text);
    return { row, text, number, place: Number(row.dataset.place) };
  });
  keyed.sort((a, b) => {
    if (!now) return a.place - b.place;
    if (Number.isNaN(a.number) !== Number.isNaN(b.number)) return Number.isNaN(a.number) ? 1 : -1;
    const before = Number.isNaN(a.number) ? a.text.localeCompare(b.text) : a.number - b.number;
    return sign * before || a.place - b.place;
  });
  body.append(...keyed.map((one) => one.row));
}

// Esc leaves the full size of a figure.
addEventListener("keydown", (event) => {
  if (event.key !== "Escape") return;
  for (const box of document.querySelectorAll(".picture input:checked")) box.checked = false;
});

for (const heading of typeof document === "undefined" ? [] : document.querySelectorAll(".scroll thead th")) {
  const button = document.createElement("button");
  button.append(...heading.childNodes);
  heading.append(button);
  button.title = "Sort";
  button.addEventListener("click", () => sortRows(heading));
}

// The contents mark the last part whose heading has come to the upper third of the window.
function markContents(links) {
  const above = links.filter((one) => document.querySelector(one.hash).getBoundingClientRect().top < innerHeight / 3);
  for (const one of links) one.removeAttribute("aria-current");
  const now = above.at(-1) ?? links[0];
  now.setAttribute("aria-current", "true");
  now.parentElement.scrollLeft = now.offsetLeft - 40;
}

const contents = typeof document === "undefined" ? [] : [...document.querySelectorAll("nav a")];
if (contents.length) {
  addEventListener("scroll", () => markContents(contents), { passive: true });
  markContents(contents);
}

"use strict";
// Paper cannot be unfolded. What was folded is folded again afterwards.
addEventListener("beforeprint", () => {
  for (const part of document.querySelectorAll("details:not([open])")) { part.open = true; part.dataset.folded = ""; }
});
addEventListener("afterprint", () => {
  for (const part of document.querySelectorAll("[data-folded]")) { part.open = false; delete part.dataset.folded; }
});

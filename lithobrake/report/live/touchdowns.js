"use strict";
// The touchdowns of one journey: one of them at a time in three dimensions, chosen by its number.

function showTouchdowns(holder) {
  const choice = holder.querySelector("select"), words = holder.querySelector(".note"), place = holder.querySelector("div");
  let view = null;
  const show = async () => {
    // A browser keeps few pictures of the machine at once, so the one before is given back.
    view?.gl.getExtension("WEBGL_lose_context")?.loseContext();
    const name = choice.value, canvas = element("canvas", { tabIndex: 0, role: "img", ariaLabel: choice.selectedOptions[0].textContent });
    const shown = element("div", { id: name }, canvas, element("div", { className: "tools" }));
    place.replaceChildren(shown);
    const started = start3d(name, (inside, scene, found) =>
      showLanding(inside, { ...scene, poses: poses(found, scene), shading: found }, found.times));
    words.textContent = JSON.parse(document.getElementById(`${name}-data`).textContent).words;
    view = await started;
    return view;
  };
  choice.addEventListener("change", () => { holder.view = show(); });
  holder.view = show();
  return holder;
}

const touchdowns3d = showTouchdowns(document.getElementById("touchdowns-3d"));

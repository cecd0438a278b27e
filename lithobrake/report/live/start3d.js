"use strict";
// The views of the page begin.

const landing3d = start3d("landing-3d", (holder, scene, found) =>
  showLanding(holder, { ...scene, poses: poses(found, scene), shading: found }, found.times));
const body3d = start3d("body-3d", showWays);

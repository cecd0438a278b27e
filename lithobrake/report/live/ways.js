"use strict";
// The body with the ways of landers: a marker that moves along one of them at a time, from flight to flight.

// Poses of a body that stands at the origin and of a marker at each place of a way [frames 3].
function wayPoses(places) {
  const count = places.length / 3, made = new Float32Array(16 * count);
  for (let frame = 0; frame < count; frame++) {
    made[16 * frame + 7] = made[16 * frame + 15] = 1;
    made.set(places.subarray(3 * frame, 3 * frame + 3), 16 * frame + 8);
  }
  return made;
}

// A time in the unit of a reader.
function shortTime(seconds) {
  return seconds < 7200 ? `${(seconds / 60).toFixed(1)} min` : `${(seconds / 3600).toFixed(2)} h`;
}

// found: way_place [places 3], way_time [places] since each flight began [s]; scene.ways: words and flights of each way,
// the first place of its first flight and the places of a flight.
function showWays(holder, scene, found) {
  const { ways, perFlight } = scene, canvas = holder.querySelector("canvas"), tools = holder.querySelector(".tools");
  const placesOf = (way) => found.way_place.subarray(3 * way.first, 3 * (way.first + way.flights * perFlight));
  const still = Float32Array.of(0, 0, 0, 0, 0, 0, 0, 1);
  const first = ways.length ? wayPoses(placesOf(ways[0])) : still;
  const view = new View3d(canvas, { ...scene, poses: first });
  const bar = colourBar();
  if (scene.bar) { bar.show(scene.bar); tools.append(bar.box); }
  if (!ways.length) { view.draw(); return view; }
  let way = ways[0];
  const shown = element("output"), choice = element("select", { ariaLabel: "Lander" },
    ...ways.map(({ words }, place) => element("option", { value: place, textContent: words })));
  const draw = () => {
    view.moment = Math.min(Number(slider.value), way.flights * perFlight - 1);
    const place = Math.round(view.moment), flight = Math.floor(place / perFlight);
    shown.textContent = `flight ${flight + 1} of ${way.flights}, ${shortTime(found.way_time[way.first + place])}`;
    view.draw();
  };
  const { slider, button, stop } = player("Place on the way", way.flights * perFlight - 1, draw);
  choice.addEventListener("change", () => {
    stop();
    way = ways[Number(choice.value)];
    view.scene.poses = wayPoses(placesOf(way));
    view.colourBy(null);
    slider.max = way.flights * perFlight - 1;
    slider.value = 0;
    draw();
  });
  tools.prepend(choice, button, slider, shown);
  draw();
  return view;
}

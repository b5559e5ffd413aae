"use strict";
// Colours come from the style sheet, so plots follow light, dark and print.
(() => {
  let cached = new Map();
  const watchers = new Set();

  plantar.colour = (name) => {
    if (!cached.has(name)) {
      cached.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
    }
    return cached.get(name);
  };

  plantar.onRecolour = (redraw) => watchers.add(redraw);

  const recolour = () => {
    cached = new Map();
    for (const redraw of watchers) redraw();
  };
  for (const query of ["(prefers-color-scheme: dark)", "print"]) {
    matchMedia(query).addEventListener("change", recolour);
  }

  // The paper draws the right foot red and the left foot blue.
  plantar.footColour = (foot, index) =>
    foot === "right" ? "red" : foot === "left" ? "blue" : ["blue", "red", "third"][index % 3];
})();

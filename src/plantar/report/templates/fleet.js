"use strict";
// Draws a robot when it is opened: its stiffness over the days, with bands, and links to its groups.
(() => {
  const HEIGHT = 220;
  const robots = JSON.parse(document.getElementById("units").textContent);

  const options = (series, width) => {
    const [low, high, sureLow, sureHigh] = series.bounds;
    const band = (value) => series.time.map((time) => (series.since === null || time >= series.since ? value : null));
    const edge = () => ({ points: { show: false }, width: 1, stroke: () => plantar.colour("grid") });
    return {
      data: [series.time, series.values, ...[sureHigh, sureLow, high, low].map(band)],
      options: {
        width,
        height: HEIGHT,
        legend: { show: false },
        cursor: { y: false, drag: { x: true, y: false } },
        axes: [plantar.axis("", 34), plantar.axis(series.title.split(" ").pop(), 64)],
        bands: [
          { series: [2, 3], fill: () => plantar.colour("shade") },
          { series: [4, 5], fill: () => plantar.colour("shade") },
        ],
        series: [
          {},
          { label: "K", stroke: () => plantar.colour(series.foot === "right" ? "red" : "blue"), width: 0,
            paths: () => null, points: { show: true, size: 4,
              fill: () => plantar.colour(series.foot === "right" ? "red" : "blue") } },
          edge(), edge(), edge(), edge(),
        ],
      },
    };
  };

  const draw = (details, robot) => {
    const plots = details.querySelector(".plots");
    for (const series of robot.series) {
      const figure = document.createElement("figure");
      figure.className = "plot";
      const caption = document.createElement("figcaption");
      caption.textContent = series.title;
      const host = document.createElement("div");
      host.setAttribute("role", "img");
      host.setAttribute("aria-label", `${series.title} over time`);
      figure.append(caption, host);
      plots.append(figure);
      const { data, options: wanted } = options(series, Math.max(host.clientWidth, 200));
      plantar.settle(new uPlot(wanted, data, host), host, HEIGHT);
    }
    const list = details.querySelector(".groups");
    for (const [name, day, key] of robot.groups) {
      const item = document.createElement("li");
      const link = document.createElement("a");
      link.href = `groups/${key}/result.json`;
      link.textContent = name;
      const where = document.createElement("code");
      where.textContent = `groups/${key}`;
      item.append(link, ` ${day} `, where);
      list.append(item);
    }
  };

  for (const details of document.querySelectorAll("details.motion")) {
    details.addEventListener("toggle", () => {
      if (details.open) draw(details, robots[Number(details.dataset.robot)]);
    }, { once: true });
  }
})();

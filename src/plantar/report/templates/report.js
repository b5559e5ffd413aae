"use strict";
// Wires the page: data is decoded and plots are drawn when a motion first comes into view.
(() => {
  const UNITS = {
    pitch: { deflection: "pitch [mrad]", torque: "torque [N·m]" },
    roll: { deflection: "roll [mrad]", torque: "torque [N·m]" },
    z: { deflection: "z [mm]", torque: "force [N]" },
  };

  const block = (kind, motion) => document.querySelector(`script.${kind}[data-motion="${motion}"]`).textContent;

  const soles = JSON.parse(document.getElementById("soles").textContent);

  const lines = (tracks, key) =>
    tracks.flatMap((track, index) => track.values[key]
      ? [{ label: track.foot, colour: plantar.footColour(track.foot, index), width: 1,
           time: track.time, values: track.values[key] }]
      : []);

  // A bush in the air carries nothing and its angle says nothing: it is not drawn.
  const standing = (tracks) => {
    const shown = tracks.filter((track) => track.air.includes(0));
    if (shown.length === 0) return tracks;
    return shown.map((track) => ({ ...track, values: Object.fromEntries(Object.entries(track.values).map(
      ([key, values]) => [key, values.map((value, i) => (track.air[i] ? null : value))])) }));
  };

  const torqueLines = (track, axis) =>
    [["measured", "red", 1, "torque"], ["reconstructed", "blue", 1.5, "predicted"]].flatMap(
      ([label, colour, width, what]) => {
        const values = track.values[`${axis}.${what}`];
        return values ? [{ label, colour, width, time: track.time, values }] : [];
      });

  const draw = (figure, motion) => {
    const host = figure.querySelector(".canvas");
    const { kind, foot, axis } = figure.dataset;
    const { tracks, frame, key } = motion;
    const track = tracks.find((one) => one.foot === foot);
    if (kind === "angles") {
      plantar.timePlot(host, key, frame, UNITS[axis].deflection, lines(standing(tracks), `${axis}.deflection`), null);
    } else if (kind === "force") {
      plantar.timePlot(host, key, frame, "force z [N]", lines(tracks, "force_z"), null);
    } else if (kind === "pressure") {
      plantar.pressurePlot(host, frame, tracks, soles);
    } else if (kind === "torque") {
      plantar.timePlot(host, key, frame, UNITS[axis].torque, torqueLines(track, axis), track);
    } else {
      plantar.loopPlot(host, frame, track, axis, UNITS[axis]);
    }
    host.classList.add("drawn");
  };

  const open = async (details) => {
    const id = details.dataset.motion;
    const tracks = await plantar.decode(JSON.parse(block("header", id)), block("samples", id));
    const start = Math.min(...tracks.map((track) => track.time[0]));
    const end = Math.max(...tracks.map((track) => track.time[track.time.length - 1]));
    const frame = new plantar.Timeframe(start, end);
    const shown = details.querySelector(".shown");
    frame.listeners.add(() => {
      const [from, to] = frame.range;
      shown.textContent = frame.zoomed ? `${from.toFixed(2)} to ${to.toFixed(2)} s` : "";
    });
    details.querySelector(".reset").addEventListener("click", () => frame.reset());
    for (const svg of details.querySelectorAll(".timeline svg")) {
      frame.listeners.add(() => {
        const [from, to] = frame.range;
        svg.setAttribute("viewBox", `${from} 0 ${to - from} 10`);
      });
    }
    return { tracks, frame, key: `motion-${id}` };
  };

  const complain = (details) => {
    const message = document.createElement("p");
    message.className = "remark";
    message.textContent = typeof DecompressionStream === "undefined"
      ? "This browser is too old to unpack the samples; the tables are complete."
      : "The samples cannot be unpacked: the page seems to be damaged.";
    details.querySelector(".controls").after(message);
  };

  const motions = new Map();
  const watcher = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      watcher.unobserve(entry.target);
      const details = entry.target.closest("details.motion");
      if (!motions.has(details)) {
        motions.set(details, open(details).catch(() => complain(details)));
      }
      motions.get(details).then((motion) => motion && draw(entry.target, motion));
    }
  }, { rootMargin: "300px" });
  for (const figure of document.querySelectorAll("figure.plot")) watcher.observe(figure);

  for (const timeline of document.querySelectorAll(".timeline")) {
    const output = timeline.querySelector("output");
    timeline.addEventListener("pointerover", (event) => {
      output.textContent = event.target.querySelector?.("title")?.textContent ?? "";
    });
    timeline.addEventListener("pointerleave", () => { output.textContent = ""; });
  }

  const all = (wanted) => () => {
    for (const details of document.querySelectorAll("details.motion")) details.open = wanted;
  };
  document.getElementById("open-all")?.addEventListener("click", all(true));
  document.getElementById("close-all")?.addEventListener("click", all(false));
})();

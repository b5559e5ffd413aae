"use strict";
// Plots over time. All plots of a motion share one time window, kept by its `Timeframe`.
(() => {
  const HEIGHT = 210;
  const AXIS = 64; // width of the y axis [px]; the timeline's labels are as wide

  plantar.Timeframe = class {
    constructor(start, end) {
      this.full = [start, end];
      this.range = [start, end];
      this.listeners = new Set();
    }
    get zoomed() {
      return this.range[0] > this.full[0] || this.range[1] < this.full[1];
    }
    set(from, to) {
      const range = [Math.max(from, this.full[0]), Math.min(to, this.full[1])];
      if (range[0] === this.range[0] && range[1] === this.range[1]) return;
      if (!(range[1] - range[0] > 1e-6)) return;
      this.range = range;
      for (const listener of this.listeners) listener(this);
    }
    reset() {
      this.set(...this.full);
    }
  };

  plantar.readable = (value) =>
    value == null ? "–" : (Math.abs(value) >= 100 ? value.toFixed(1) : value.toFixed(3)).replace("-", "−");

  plantar.axis = (label, size) => ({
    label,
    labelSize: 20,
    labelFont: "12px system-ui, sans-serif",
    font: "12px system-ui, sans-serif",
    size,
    stroke: () => plantar.colour("ink-soft"),
    grid: { stroke: () => plantar.colour("grid"), width: 1 },
    ticks: { stroke: () => plantar.colour("grid"), width: 1, size: 5 },
  });

  plantar.line = (label, colour, width) => ({
    label,
    stroke: () => plantar.colour(colour),
    width,
    spanGaps: false,
    points: { show: false },
    value: (_plot, value) => plantar.readable(value),
  });

  // Keeps a plot as wide as its place and in the page's colours.
  plantar.settle = (plot, host, height) => {
    plantar.onRecolour(() => {
      plot.redraw(false, true);
      const markers = [...plot.root.querySelectorAll(".u-marker")].slice(1 - plot.series.length);
      markers.forEach((marker, i) => { marker.style.borderColor = plot.series[i + 1].stroke(plot, i + 1); });
    });
    new ResizeObserver(() => {
      const width = host.clientWidth;
      if (width > 0 && width !== plot.width) plot.setSize({ width, height });
    }).observe(host);
    host.plot = plot;
    return plot;
  };

  // Grey bands behind the samples used neither for fit nor for score.
  const shade = (track) => (plot) => {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.fillStyle = plantar.colour("shade");
    const [from, to] = [plot.scales.x.min, plot.scales.x.max];
    let start = -1;
    for (let i = 0; i <= track.used.length; i++) {
      const out = i < track.used.length && track.used[i] === 0;
      if (out && start < 0) start = i;
      if (out || start < 0) continue;
      const [a, b] = [Math.max(from, track.time[start]), Math.min(to, track.time[Math.min(i, track.time.length - 1)])];
      if (b >= a) {
        const left = plot.valToPos(a, "x", true);
        ctx.fillRect(left, bbox.top, Math.max(1, plot.valToPos(b, "x", true) - left), bbox.height);
      }
      start = -1;
    }
    ctx.restore();
  };

  const sameTimes = (a, b) => a.length === b.length && a.every((time, i) => time === b[i]);

  // One x axis for all lines: the tracks' own where they agree, else their union.
  const aligned = (lines) => {
    const [first] = lines;
    if (lines.every((line) => line.time === first.time || sameTimes(line.time, first.time))) {
      return [first.time, ...lines.map((line) => line.values)];
    }
    return uPlot.join(lines.map((line) => [line.time, line.values]));
  };

  // A reconstruction of samples that were left out may be anywhere: it does not set the scale.
  const rangeOfUsed = (track) => (plot, low, high) => {
    const [first, last] = plot.series[0].idxs ?? [0, plot.data[0].length - 1];
    let [min, max] = [Infinity, -Infinity];
    plot.data.slice(1).forEach((values, line) => {
      for (let i = first; i <= last; i++) {
        if (values[i] == null || (line > 0 && track.used[i] === 0)) continue;
        if (values[i] < min) min = values[i];
        if (values[i] > max) max = values[i];
      }
    });
    return min > max ? uPlot.rangeNum(low ?? 0, high ?? 1, 0.1, true) : uPlot.rangeNum(min, max, 0.1, true);
  };

  // `lines`: [{label, colour, width, time, values}]
  plantar.timePlot = (host, key, frame, unit, lines, shaded) => {
    let plot = null;
    const options = {
      width: Math.max(host.clientWidth, 200),
      height: HEIGHT,
      scales: { x: { time: false }, ...(shaded ? { y: { range: rangeOfUsed(shaded) } } : {}) },
      padding: [8, 12, 0, 0],
      cursor: {
        sync: { key, scales: ["x", null], filters: { pub: (type) => type === "mousemove" || type === "mouseleave" } },
        y: false,
        drag: { x: true, y: false, dist: 4 },
        bind: { dblclick: () => () => frame.reset() },
      },
      axes: [plantar.axis("time [s]", 30), plantar.axis(unit, AXIS)],
      series: [
        { label: "time [s]", value: (_plot, value) => plantar.readable(value) },
        ...lines.map((line) => plantar.line(line.label, line.colour, line.width)),
      ],
      hooks: {
        drawClear: shaded ? [shade(shaded)] : [],
        setScale: [(self, scale) => {
          if (scale === "x" && plot !== null) frame.set(self.scales.x.min, self.scales.x.max);
        }],
      },
    };
    plot = new uPlot(options, aligned(lines), host);
    const follow = () => {
      const [min, max] = frame.range;
      if (plot.scales.x.min !== min || plot.scales.x.max !== max) plot.setScale("x", { min, max });
    };
    frame.listeners.add(follow);
    follow();
    return plantar.settle(plot, host, HEIGHT);
  };
})();

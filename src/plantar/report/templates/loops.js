"use strict";
// Torque over angle: what the spring and the damper look like. Only the motion's time window is drawn.
(() => {
  const HEIGHT = 260;

  const extent = (columns, keep) => {
    let [low, high] = [Infinity, -Infinity];
    for (const values of columns) {
      for (let i = 0; i < values.length; i++) {
        if (values[i] === null || !keep(i)) continue;
        if (values[i] < low) low = values[i];
        if (values[i] > high) high = values[i];
      }
    }
    if (low > high) return null;
    const margin = 0.05 * (high - low) || 1;
    return [low - margin, high + margin];
  };

  // The samples that served give the view; where none did, all of them.
  const view = (track, columns) =>
    extent(columns, (i) => track.used[i] === 1) ?? extent(columns, () => true) ?? [-1, 1];

  const strokeLine = (plot, colour, width, x, y, wanted) => {
    const { ctx, bbox, scales } = plot;
    const dx = bbox.width / (scales.x.max - scales.x.min);
    const dy = bbox.height / (scales.y.max - scales.y.min);
    ctx.strokeStyle = plantar.colour(colour);
    ctx.lineWidth = width * devicePixelRatio;
    ctx.lineJoin = "round";
    ctx.beginPath();
    let pen = false;
    for (let i = 0; i < x.length; i++) {
      if (x[i] === null || y[i] === null || !wanted(i)) {
        pen = false;
        continue;
      }
      const px = bbox.left + (x[i] - scales.x.min) * dx;
      const py = bbox.top + bbox.height - (y[i] - scales.y.min) * dy;
      if (pen) ctx.lineTo(px, py);
      else ctx.moveTo(px, py);
      pen = true;
    }
    ctx.stroke();
  };

  plantar.loopPlot = (host, frame, track, axis, units) => {
    const x = track.values[`${axis}.deflection`];
    const measured = track.values[`${axis}.torque`];
    const predicted = track.values[`${axis}.predicted`] ?? [];
    const draw = (plot) => {
      const [from, to] = frame.range;
      const inside = (i) => track.time[i] >= from && track.time[i] <= to;
      const { ctx, bbox } = plot;
      ctx.save();
      ctx.beginPath();
      ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
      ctx.clip();
      strokeLine(plot, "faint", 1, x, measured, (i) => inside(i) && track.used[i] === 0);
      strokeLine(plot, "red", 1, x, measured, (i) => inside(i) && track.used[i] === 1);
      strokeLine(plot, "blue", 1, x, predicted, (i) => inside(i) && track.used[i] === 1);
      ctx.restore();
    };
    const [xs, ys] = [view(track, [x]), view(track, [measured, predicted])];
    const facets = [{ scale: "x", auto: true }, { scale: "y", auto: true }];
    const series = (label, colour) => ({ ...plantar.line(label, colour, 2), facets, paths: () => null });
    const options = {
      mode: 2,
      width: Math.max(host.clientWidth, 200),
      height: HEIGHT,
      padding: [8, 12, 0, 0],
      scales: { x: { time: false, range: () => xs }, y: { range: () => ys } },
      legend: { live: false },
      cursor: {
        drag: { x: true, y: true, dist: 4 },
        points: { show: false },
        dataIdx: () => null,
        bind: {
          dblclick: (self) => () => {
            self.setScale("x", { min: xs[0], max: xs[1] });
            self.setScale("y", { min: ys[0], max: ys[1] });
          },
        },
      },
      axes: [plantar.axis(units.deflection, 30), plantar.axis(units.torque, 64)],
      series: [null, series("measured", "red"), series("reconstructed", "blue"), series("left out", "faint")],
      hooks: { draw: [draw] },
    };
    const corners = [xs, ys];
    const plot = new uPlot(options, [null, corners, corners, corners], host);
    frame.listeners.add(() => plot.redraw(false, false));
    return plantar.settle(plot, host, HEIGHT);
  };
})();

"use strict";
// Plots of one quantity over another: torque over angle (the loop), and where the pressure lies in the sole. Only the
// motion's time window is drawn; samples that were left out are grey.
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

  // The used samples give the view; where there are none, all of them.
  const view = (track, columns) =>
    extent(columns, (i) => track.used[i] === 1) ?? extent(columns, () => true) ?? [-1, 1];

  const union = (ranges) => [Math.min(...ranges.map(([low]) => low)), Math.max(...ranges.map(([, high]) => high))];

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

  const clipped = (draw) => (plot) => {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    draw(plot);
    ctx.restore();
  };

  // `legend`: [label, colour] of what `draw` will draw; `x` and `y`: axis label and range.
  const planePlot = (host, frame, x, y, legend, draw) => {
    const facets = [{ scale: "x", auto: true }, { scale: "y", auto: true }];
    const series = legend.map(([label, colour]) =>
      ({ ...plantar.line(label, colour, 2), facets, paths: () => null }));
    const whole = (plot) => {
      plot.setScale("x", { min: x.range[0], max: x.range[1] });
      plot.setScale("y", { min: y.range[0], max: y.range[1] });
    };
    const options = {
      mode: 2,
      width: Math.max(host.clientWidth, 200),
      height: HEIGHT,
      padding: [8, 12, 0, 0],
      scales: { x: { time: false, range: () => x.range }, y: { range: () => y.range } },
      legend: { live: false },
      cursor: {
        drag: { x: true, y: true, dist: 4 },
        points: { show: false },
        dataIdx: () => null,
        bind: { dblclick: (self) => () => whole(self) },
      },
      axes: [plantar.axis(x.label, 30), plantar.axis(y.label, 64)],
      series: [null, ...series],
      hooks: { draw: [clipped(draw)] },
    };
    const plot = new uPlot(options, [null, ...series.map(() => [x.range, y.range])], host);
    frame.listeners.add(() => plot.redraw(false, false));
    return plantar.settle(plot, host, HEIGHT);
  };

  const within = (frame, track, used) => (i) =>
    track.used[i] === used && track.time[i] >= frame.range[0] && track.time[i] <= frame.range[1];

  plantar.loopPlot = (host, frame, track, axis, units) => {
    const angle = track.values[`${axis}.deflection`];
    const measured = track.values[`${axis}.torque`];
    const predicted = track.values[`${axis}.predicted`] ?? [];
    const x = { label: units.deflection, range: view(track, [angle]) };
    const y = { label: units.torque, range: view(track, [measured, predicted]) };
    const legend = [["measured", "red"], ["reconstructed", "blue"], ["left out", "faint"]];
    return planePlot(host, frame, x, y, legend, (plot) => {
      strokeLine(plot, "faint", 1, angle, measured, within(frame, track, 0));
      strokeLine(plot, "red", 1, angle, measured, within(frame, track, 1));
      strokeLine(plot, "blue", 1, angle, predicted, within(frame, track, 1));
    });
  };

  // `soles`: each foot's outline [[x, y], ..] in mm, where the result knows it.
  plantar.pressurePlot = (host, frame, tracks, soles) => {
    const shown = tracks.filter((track) => track.values.cop_x && track.values.cop_y);
    const outlines = shown.map((track) => soles[track.foot] ?? []).filter((outline) => outline.length > 2);
    const range = (key, coordinate) => union([
      ...shown.map((track) => view(track, [track.values[key]])),
      ...outlines.map((outline) => extent([outline.map((corner) => corner[coordinate])], () => true)),
    ]);
    const x = { label: "forward in the sole [mm]", range: range("cop_x", 0) };
    const y = { label: "left in the sole [mm]", range: range("cop_y", 1) };
    const colours = shown.map((track, index) => plantar.footColour(track.foot, index));
    const legend = [...shown.map((track, index) => [track.foot, colours[index]]), ["left out", "faint"]];
    return planePlot(host, frame, x, y, legend, (plot) => {
      for (const outline of outlines) {
        const ring = [...outline, outline[0]];
        strokeLine(plot, "ink-soft", 1.5, ring.map(([px]) => px), ring.map(([, py]) => py), () => true);
      }
      for (const track of shown) {
        strokeLine(plot, "faint", 1, track.values.cop_x, track.values.cop_y, within(frame, track, 0));
      }
      shown.forEach((track, index) => {
        strokeLine(plot, colours[index], 1, track.values.cop_x, track.values.cop_y, within(frame, track, 1));
      });
    });
  };
})();

"use strict";
// Draws the robot's boxes on a canvas, far ones first, and plays its motions.
(() => {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  const [stage, chooser, button, slider, now, times, factor, angles] =
    ["stage", "motion", "play", "time", "now", "times", "factor", "angles"].map((id) => document.getElementById(id));
  const width = scene.bodies.length - 1 + 2 * scene.feet.length;
  const first = { turn: -0.9, lift: 0.22, distance: 3.4 };
  const eye = { ...first };
  const aim = [0, 0, 0.72];
  let motion, codes, frame = 0, playing = true, last = null;

  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  const shades = new Map();
  const shade = (name, light) => {
    const key = `${name}${light.toFixed(2)}`;
    if (!shades.has(key)) {
      const hex = colour(name);
      const parts = [1, 3, 5].map((at) => Math.round(parseInt(hex.slice(at, at + 2), 16) * light + 255 * 0.16));
      shades.set(key, `rgb(${parts.map((part) => Math.min(part, 255)).join(" ")})`);
    }
    return shades.get(key);
  };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { shades.clear(); draw(); });

  // World to screen: x, y [pixel] and depth [m]; the camera looks at `aim`.
  const projector = () => {
    const [ct, st, cl, sl] = [Math.cos(eye.turn), Math.sin(eye.turn), Math.cos(eye.lift), Math.sin(eye.lift)];
    const right = [-st, ct, 0], forward = [-ct * cl, -st * cl, -sl], up = [-ct * sl, -st * sl, cl];
    const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const zoom = 1.9 * Math.min(stage.clientHeight, stage.clientWidth);
    return (point) => {
      const from = point.map((part, place) => part - aim[place]);
      const depth = eye.distance + dot(from, forward);
      const scale = zoom / Math.max(depth, 0.1);
      return [stage.clientWidth / 2 + scale * dot(from, right), stage.clientHeight / 2 - scale * dot(from, up), depth];
    };
  };

  const FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
  const corners = (centre, size) => [0, 1, 2, 3, 4, 5, 6, 7].map((place) =>
    centre.map((part, axis) => part + size[axis] * ((place >> (2 - axis)) & 1 ? 0.5 : -0.5)));

  const faces = () => {
    const values = Array.from(codes.subarray(frame * width, (frame + 1) * width), (code) => code * scene.step);
    const placed = robot.placed(scene, motion, values, Number(times.value));
    const found = [];
    const add = (points, name) => {
      for (const face of FACES) found.push({ points: face.map((place) => points[place]), name });
    };
    scene.bodies.forEach((body, place) => {
      for (const [centre, size] of body.boxes) {
        const points = corners(centre, size).map((point) => robot.apply(placed.bodies[place], point));
        add(points, { right: "red", left: "blue" }[body.side] ?? "faint");
      }
    });
    scene.feet.forEach((foot, place) => {
      const below = foot.corners.map((point) => robot.apply(placed.soles[place], point));
      const above = foot.corners.map(([x, y, z]) => robot.apply(placed.soles[place], [x, y, z + 0.012]));
      found.push({ points: above, name: "ink-soft" }, { points: below, name: "ink-soft" });
      below.forEach((_, at) => {
        const next = (at + 1) % below.length;
        found.push({ points: [below[at], below[next], above[next], above[at]], name: "ink-soft" });
      });
    });
    return found;
  };

  const lit = ([a, b, c]) => {
    const [u, v] = [b, c].map((point) => point.map((part, axis) => part - a[axis]));
    const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const size = Math.hypot(...normal) || 1;
    return 0.55 + 0.3 * Math.abs(normal[2] / size) + 0.12 * Math.abs(normal[0] / size);
  };

  const path = (context, points) => {
    context.beginPath();
    points.forEach(([x, y], place) => (place ? context.lineTo(x, y) : context.moveTo(x, y)));
    context.closePath();
  };

  const draw = () => {
    const context = stage.getContext("2d"), ratio = devicePixelRatio || 1;
    stage.width = Math.round(stage.clientWidth * ratio);
    stage.height = Math.round(stage.clientHeight * ratio);
    context.scale(ratio, ratio);
    context.lineJoin = "round";
    const project = projector();
    context.strokeStyle = colour("rule");
    for (let way = -5; way <= 5; way++) {
      for (const [from, to] of [[[way / 5, -1, 0], [way / 5, 1, 0]], [[-1, way / 5, 0], [1, way / 5, 0]]]) {
        path(context, [project(from), project(to)]);
        context.stroke();
      }
    }
    const seen = faces().map((face) => {
      const points = face.points.map(project);
      return { points, depth: points.reduce((sum, point) => sum + point[2], 0) / points.length, face };
    });
    seen.sort((a, b) => b.depth - a.depth);
    for (const { points, face } of seen) {
      path(context, points);
      context.fillStyle = context.strokeStyle = shade(face.name, lit(face.points));
      context.fill();
      context.stroke();
    }
    tell();
  };

  const tell = () => {
    now.textContent = `${(frame / scene.rate).toFixed(1)} s`;
    factor.textContent = `${times.value} times as far`;
    const start = frame * width + scene.bodies.length - 1;
    const bush = (place, axis) => ((codes[start + 2 * place + axis] * scene.step * 180) / Math.PI).toFixed(2);
    angles.textContent = scene.feet.map((foot, place) =>
      `${foot.name} bush: pitch ${bush(place, 0)}°, roll ${bush(place, 1)}°`).join(";  ");
  };

  const choose = () => {
    motion = scene.motions[Number(chooser.value)];
    codes = robot.decode(motion);
    frame = 0;
    slider.max = motion.frames - 1;
    slider.value = 0;
    draw();
  };

  const tick = (moment) => {
    if (playing && (last === null || moment - last >= 1000 / scene.rate)) {
      last = moment;
      frame = (frame + 1) % motion.frames;
      slider.value = frame;
      draw();
    }
    requestAnimationFrame(tick);
  };

  button.addEventListener("click", () => {
    playing = !playing;
    button.textContent = playing ? "Pause" : "Play";
  });
  slider.addEventListener("input", () => {
    frame = Math.round(Number(slider.value));
    if (playing) button.click();
    draw();
  });
  chooser.addEventListener("change", choose);
  times.addEventListener("input", draw);
  stage.addEventListener("pointerdown", (event) => stage.setPointerCapture(event.pointerId));
  stage.addEventListener("pointermove", (event) => {
    if (!event.buttons) return;
    eye.turn -= event.movementX / 200;
    eye.lift = Math.min(1.5, Math.max(-0.1, eye.lift + event.movementY / 200));
    draw();
  });
  stage.addEventListener("wheel", (event) => {
    event.preventDefault();
    eye.distance = Math.min(12, Math.max(0.6, eye.distance * Math.exp(event.deltaY / 800)));
    draw();
  }, { passive: false });
  stage.addEventListener("keydown", (event) => {
    const way = { ArrowLeft: -0.1, ArrowRight: 0.1 }[event.key];
    if (way === undefined) return;
    eye.turn += way;
    draw();
  });
  stage.addEventListener("dblclick", () => { Object.assign(eye, first); draw(); });
  addEventListener("resize", draw);
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) button.click();
  choose();
  requestAnimationFrame(tick);
})();

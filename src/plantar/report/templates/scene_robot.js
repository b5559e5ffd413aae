"use strict";
// The robot's kinematics. A pose is twelve numbers: the first three rows of a 4 x 4 matrix.
const robot = {};

(() => {
  const multiply = (a, b) => {
    const found = new Array(12);
    for (let row = 0; row < 12; row += 4) {
      for (let column = 0; column < 4; column++) {
        found[row + column] = a[row] * b[column] + a[row + 1] * b[4 + column] + a[row + 2] * b[8 + column];
      }
      found[row + 3] += a[row + 3];
    }
    return found;
  };

  const inverse = (a) => {
    const turned = [a[0], a[4], a[8], 0, a[1], a[5], a[9], 0, a[2], a[6], a[10], 0];
    for (let row = 0; row < 3; row++) {
      turned[4 * row + 3] = -(turned[4 * row] * a[3] + turned[4 * row + 1] * a[7] + turned[4 * row + 2] * a[11]);
    }
    return turned;
  };

  // rotation about a unit axis
  const turn = ([x, y, z], angle) => {
    const c = Math.cos(angle), s = Math.sin(angle), d = 1 - c;
    return [
      c + d * x * x, d * x * y - s * z, d * x * z + s * y, 0,
      d * x * y + s * z, c + d * y * y, d * y * z - s * x, 0,
      d * x * z - s * y, d * y * z + s * x, c + d * z * z, 0,
    ];
  };

  const slide = ([x, y, z], way) => [1, 0, 0, x * way, 0, 1, 0, y * way, 0, 0, 1, z * way];

  // R_ankle_sole = Ry(pitch) Rx(roll)
  const bend = (pitch, roll) => multiply(turn([0, 1, 0], pitch), turn([1, 0, 0], roll));

  robot.apply = (a, [x, y, z]) => [0, 4, 8].map((row) => a[row] * x + a[row + 1] * y + a[row + 2] * z + a[row + 3]);

  // Poses of all bodies in the root's frame.
  const tree = (bodies, joints) => {
    const poses = [];
    bodies.forEach((body, place) => {
      if (body.parent < 0) {
        poses.push([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]);
        return;
      }
      const moved = (body.slides ? slide : turn)(body.axis, joints[place - 1]);
      poses.push(multiply(multiply(poses[body.parent], body.pose), moved));
    });
    return poses;
  };

  // The mean of poses that lie near each other: places halfway, the first one's turn led halfway by its columns.
  const middle = (poses) => {
    const mean = poses[0].map((_, place) => poses.reduce((sum, pose) => sum + pose[place], 0) / poses.length);
    const column = (place) => [mean[place], mean[4 + place], mean[8 + place]];
    const scaled = (v) => { const size = Math.hypot(...v); return v.map((part) => part / size); };
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    const z = scaled(column(2)), y = scaled(cross(z, column(0))), x = cross(y, z);
    return [0, 1, 2].flatMap((row) => [x[row], y[row], z[row], mean[4 * row + 3]]);
  };

  // Poses of bodies and soles in the world: soles stand where they stood, the bushes bend `times` as far.
  robot.placed = (scene, motion, values, times) => {
    const count = scene.bodies.length - 1;
    const poses = tree(scene.bodies, values);
    const bushes = scene.feet.map((foot, place) => {
      const [pitch, roll] = [values[count + 2 * place], values[count + 2 * place + 1]];
      return multiply(multiply(foot.bush, bend(times * pitch, times * roll)), foot.sole);
    });
    const roots = [];
    scene.feet.forEach((foot, place) => {
      const stance = motion.stance[foot.name];
      if (stance) roots.push(multiply(stance, inverse(multiply(poses[foot.ankle], bushes[place]))));
    });
    const root = middle(roots);
    return {
      bodies: poses.map((pose) => multiply(root, pose)),
      soles: scene.feet.map((foot, place) =>
        motion.stance[foot.name] ?? multiply(multiply(root, poses[foot.ankle]), bushes[place])),
    };
  };

  robot.decode = (motion) => {
    const bytes = Uint8Array.from(atob(motion.data), (character) => character.charCodeAt(0));
    return new Int16Array(bytes.buffer);
  };
})();

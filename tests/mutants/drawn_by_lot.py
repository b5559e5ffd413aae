"""Careless changes at places drawn by lot from every line of every room that works something out."""

from __future__ import annotations

from mutant import Mutant

DRAWN_BY_LOT = (
    Mutant(
        "sensors/delays/lagged_log.py",
        "another log's period",
        "measured.append(_moving(carried, thin.period))",
        "measured.append(_moving(carried, log.period))",
    ),
    Mutant(
        "twin/replay.py",
        "only models that can be played are made linear",
        "if axis.model not in MODELS",
        "if axis.model in MODELS",
    ),
    Mutant(
        "exporters/urdf/tree.py",
        "a package's name is no folder",
        'tails = [bare, bare.split("/", 1)[-1]]',
        'tails = [bare.split("/", 1)[-1]]',
    ),
    Mutant(
        "feet/result.py",
        "unseen motions first",
        'key=lambda row: row.kind != "direct"',
        'key=lambda row: row.kind == "direct"',
    ),
    Mutant(
        "logs/readers/ros/layouts.py",
        "one alignment for all encodings",
        "self.widest = 8 if kind[1] < 2 else 4",
        "self.widest = 8",
    ),
    Mutant(
        "exporters/contact/points.py",
        "the longer of two times",
        "min(DAMPING_TIME, softest) * rest",
        "max(DAMPING_TIME, softest) * rest",
    ),
    Mutant(
        "twin/sensing/sensor_errors.py",
        "an encoder's zero taken off",
        'columns[name] + zeros[rest.removesuffix(".position")]',
        'columns[name] - zeros[rest.removesuffix(".position")]',
    ),
    Mutant(
        "checks/joints/closed_chain.py",
        "a joint turned back",
        "positions[:, joint] += angle",
        "positions[:, joint] -= angle",
    ),
    Mutant(
        "logs/motion_log.py",
        "rates for accelerations",
        'return self.stack(imu_columns(imu, "linear_acceleration"))',
        'return self.stack(imu_columns(imu, "angular_velocity"))',
    ),
    Mutant(
        "feet/foot_fit.py",
        "an edge is nothing to mend first",
        "first = [*(note for note in found.notes if note.code == ON_AN_EDGE), *faults]",
        "first = faults",
    ),
    Mutant(
        "dynamics/fit.py",
        "the excited directions are named",
        "np.flatnonzero(~solution.excited)",
        "np.flatnonzero(solution.excited)",
    ),
    Mutant(
        "motions/stance.py",
        "the foot that stands is raised",
        "if name != foot:\n            soles[name] = soles[name] *",
        "if name == foot:\n            soles[name] = soles[name] *",
    ),
    Mutant(
        "whole_body/equations.py",
        "an IMU's turn turns no motion",
        "turned(whole.motion, calibration.rotation) if equation.floating else whole.motion",
        "whole.motion",
    ),
    Mutant(
        "conventions.py",
        "a rotation turned over",
        "rotation[..., i, j] = entry",
        "rotation[..., j, i] = entry",
    ),
    Mutant(
        "exporters/sdf/tree.py",
        "every joint is fixed",
        'if joint.get("type") == "fixed" and joint.findtext("parent", "").strip() == link',
        'if joint.findtext("parent", "").strip() == link',
    ),
    Mutant(
        "twin/sensing/sensors.py",
        "an encoder rounds down",
        "np.round(values / quantum)",
        "np.floor(values / quantum)",
    ),
    Mutant(
        "model_selection/initial_state.py",
        "samples that are not used settle it, too",
        "settling = used & (",
        "settling = (",
    ),
    Mutant(
        "sensors/delays/delays_by_log.py", "two logs are too few", "if len(found) < 2:", "if len(found) < 3:"
    ),
    Mutant(
        "results/feet.py",
        "a notebook gets no advice",
        "feet_text.advice(self.parameters)]\n        delay = feet_text.delay_line(self.sensor_delay)\n        return t",
        "()]\n        delay = feet_text.delay_line(self.sensor_delay)\n        return t",
    ),
    Mutant(
        "checks/stance.py",
        "twice what is upright for what is level",
        "level = np.eye(3) - up[:, :, None]",
        "level = np.eye(3) + up[:, :, None]",
    ),
    Mutant("sensors/newton_euler.py", "zeros added", "readings - below.zeros", "readings + below.zeros"),
    Mutant(
        "logs/save_mc_rtc.py",
        "the body in the world for the world in the body",
        "np.swapaxes(base[:, :3, :3], 1, 2).reshape(-1, 9)",
        "base[:, :3, :3].reshape(-1, 9)",
    ),
    Mutant(
        "twin/fleet.py",
        "presets with robots of their own",
        "if chosen.robot is not None or chosen.logger is not None:",
        "if chosen.robot is not None and chosen.logger is not None:",
    ),
    Mutant(
        "sensors/delays/sensor_delay.py",
        "delays as from endless data",
        "return SensorDelay(mean, found.std, found.freedom, True, note, delays, encoders)",
        "return SensorDelay(mean, found.std, np.inf, True, note, delays, encoders)",
    ),
    Mutant(
        "model_selection/selection.py",
        "a reason is written over",
        "if score.refused or score.held_out_rms < (1 - TELLING_GAIN)",
        "if score.held_out_rms < (1 - TELLING_GAIN)",
    ),
    Mutant(
        "exporters/shapes.py",
        "all that has a shape goes with the sole",
        "elif corners is None or not reaches_sole(corners, foot):",
        "elif corners is None:",
    ),
    Mutant(
        "sensors/moment_errors.py",
        "an arm makes forces of torques",
        "np.block([[none, none], [cross, none]]), place)",
        "np.block([[none, cross], [none, none]]), place)",
    ),
    Mutant(
        "model_selection/variable_projection.py",
        "counts for places",
        "np.split(states, np.cumsum(self.counts[:-1]), axis=-1)",
        "np.split(states, self.counts[:-1], axis=-1)",
    ),
    Mutant(
        "report/verdict.py",
        "those that fail beat it",
        'beaten = f"{len(rows) - len(failed)} of',
        'beaten = f"{len(failed)} of',
    ),
    Mutant(
        "checks/joints/names.py",
        "joints that are not recorded are no error",
        '(valid: a position of every joint between IMU and feet)", True)',
        '(valid: a position of every joint between IMU and feet)", False)',
    ),
    Mutant(
        "checks/channels.py",
        "a robot at rest holds its readings",
        "held = held_in(log, column) & ~rest",
        "held = held_in(log, column)",
    ),
    Mutant(
        "model_selection/data_sets.py",
        "torque where no angle is known",
        "torque = np.where(np.isfinite(path[:, 0]), self.torque, np.nan)",
        "torque = self.torque",
    ),
    Mutant(
        "exporters/sdf/drake.py",
        "pitch for roll at rest",
        "[_rest(roll), _rest(pitch), 0.0]",
        "[_rest(pitch), _rest(roll), 0.0]",
    ),
    Mutant(
        "twin/recording.py",
        "the same sensors for every seed",
        "with_sensor_errors(exact, time, robot, preset.sensor_errors, seed)",
        "with_sensor_errors(exact, time, robot, preset.sensor_errors, 0)",
    ),
    Mutant(
        "report/live.py",
        "a bush below its sole",
        "robot.frame(foot.sole.placement)[1].inverse() * robot.frame(foot.bush)[1]",
        "robot.frame(foot.sole.placement)[1] * robot.frame(foot.bush)[1].inverse()",
    ),
    Mutant(
        "motions/feasible.py",
        "a support begins a sample early",
        "np.flatnonzero(np.diff(stands, axis=1).any(axis=0)) + 1",
        "np.flatnonzero(np.diff(stands, axis=1).any(axis=0))",
    ),
    Mutant(
        "model_selection/grid.py",
        "a run beside itself",
        "_best_states(grams, totals[data_set] - current, values)",
        "_best_states(grams, totals[data_set], values)",
    ),
    Mutant(
        "cli/identify/dynamics_tables.py",
        "the lower end twice",
        '{number(row.interval95[0])} to {number(row.interval95[1])}", row.verdict',
        '{number(row.interval95[0])} to {number(row.interval95[0])}", row.verdict',
    ),
    Mutant(
        "exporters/contact/physx.py",
        "remarks are not written",
        '"PhysX\' contact", (*job.remarks, *notes), with_offset',
        '"PhysX\' contact", notes, with_offset',
    ),
    Mutant(
        "exporters/openhrp.py",
        "comments are values",
        'line.partition("#")[0].partition(":")',
        'line.partition(":")',
    ),
)

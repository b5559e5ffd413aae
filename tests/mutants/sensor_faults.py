"""Changes by which a fault of sensors, signals or files, seen before, would go unseen, or be seen in a healthy log."""

from __future__ import annotations

from mutant import Mutant

SENSOR_FAULTS = (
    Mutant(
        "signals/dropouts.py", "one channel at zero is a device that dropped out", "silent &= log.column(name) == 0",
        "silent |= log.column(name) == 0", ("signals/test_dropouts.py",),
    ),
    Mutant(
        "faults/joints/closed_chain.py", "the foot in the air may be lower than the one that carries",
        "np.where(carrying == 0, 1, -1)", "np.where(carrying == 0, 1, 1)", ("faults/joints/test_closed_chain.py",),
    ),
    Mutant(
        "faults/stance_changes.py", "force sensors are turned one at a time only",
        "{**ways, \"columns 'wrench.*'\": [*range(len(sensors))]}", "ways", ("faults/test_standing.py",),
    ),
    Mutant(
        "sensors/newton_euler.py", "the first run of a log with gaps is all", "return long or", "return long[:1] or",
        ("sensors/test_newton_euler.py",),
    ),
    Mutant(
        "sensors/moments/torque_gains.py", "torques wrong about one axis are right about the other",
        "> ALSO * wrong_by**2", "> 10 * wrong_by**2", ("sensors/moments/test_torque_gains.py",),
    ),
    Mutant(
        "signals/dropouts.py", "a coarse encoder near zero drops out", "LEAST = 0.01", "LEAST = 0.0",
        ("signals/test_dropouts.py",),
    ),
    Mutant(
        "signals/dropouts.py", "one stretch of zeros is enough", "FEWEST = 2", "FEWEST = 1",
        ("signals/test_dropouts.py",),
    ),
    Mutant(
        "faults/bush_frames.py", "feet beside each other are before each other",
        "if abs(x) > BEFORE * abs(y)", "if abs(y) > BEFORE * abs(x)", ("faults/test_bush_axes.py",),
    ),
    Mutant(
        "faults/log_faults.py", "rows that got lost are bursts",
        "log.period < QUICK * (mean", "log.period < 4 * (mean", ("faults/test_log_faults.py",),
    ),
    Mutant(
        "sensors/moments/moment_fit.py", "another unit hides behind its prior",
        "STRAINED = 2.0", "STRAINED = 200.0", ("sensors/moments/test_torque_gains.py",),
    ),
    Mutant(
        "sensors/moments/moment_fit.py", "no URDF is wrong", "np.ones(links)", "np.full(links, 1e-6)",
        ("sensors/moments/test_moment_fit.py",),
    ),
    Mutant(
        "sensors/below_sensor.py", "a foot that still carries a little swings", "(1 + strays) ** 2", "(1 + 0 * strays)",
        ("sensors/test_below_sensor.py",),
    ),
    Mutant(
        "sensors/moments/torque_gains.py", "a foot is judged by itself where nothing tells it from the other",
        "APART = 2.0", "APART = 200.0", ("sensors/moments/test_torque_gains.py",),
    ),
    Mutant(
        "sensors/moments/torque_gains.py", "no foot is judged by itself", "APART = 2.0", "APART = 0.0",
        ("sensors/moments/test_torque_gains.py",),
    ),
    Mutant(
        "sensors/moments/elimination.py", "all logs have the same zeros, none",
        "share = np.linalg.solve(", "share = 0 * np.linalg.solve(", ("sensors/moments/test_moment_fit.py",),
    ),
    Mutant(
        "feet/prepare_log.py", "what soles have put right stays a fault",
        "if note.code not in noted", "if note.code not in () and noted is not None", ("sensors/test_tilt_error.py",),
    ),
    Mutant(
        "sensors/moments/law_rows.py", "a walk is as slow as a sway",
        "QUICKER if steps else BAND", "BAND",
        ("sensors/moments/test_torque_delay.py",),
    ),
    Mutant(
        "sensors/moments/moment_errors.py", "the noise of readings is arms",
        "-= factor * _products", "-= 0 * factor * _products", ("sensors/moments/test_torque_gains.py",),
    ),
    Mutant(
        "robot_guess/passive.py", "a foot may push the way it tilts",
        "max(float(moment @ tilt) / power, 0.0)", "float(moment @ tilt) / power", ("robot_guess/test_passive.py",),
    ),
    Mutant(
        "estimation/stance_problem.py", "a stance that is left out stays",
        "drawn.sum(axis=0) - drawn)", "drawn.sum(axis=0) - 0 * drawn)", ("estimation/test_stance_least_squares.py",),
    ),
    Mutant(
        "logs/readers/read_limit.py", "a small file may unpack to anything", "RATIO = 100", "RATIO = 10**6",
        ("logs/readers/test_read_limit.py",),
    ),
    Mutant(
        "logs/readers/column_map.py", "the line for all joints beats a joint's own",
        "return spread | {key: entry for key, entry in entries.items() if ANY_JOINT not in key}",
        "return {key: entry for key, entry in entries.items() if ANY_JOINT not in key} | spread",
        ("logs/readers/test_column_map.py",),
    ),
    Mutant(
        "logs/readers/column_map.py", "the line for all joints has no unit",
        '{**made, "from": before + joint + after}', '{"from": before + joint + after}',
        ("logs/readers/test_column_map.py",),
    ),
    Mutant(
        "faults/joints/stepping_joints.py", "one landing is a step", "FEWEST = 2 ", "FEWEST = 1 ",
        ("faults/joints/test_stepping_joints.py",),
    ),
    Mutant(
        "faults/joints/stepping_joints.py", "the other leg may stand as well", "if turned[same] > TURNED:",
        "if turned[same] >= 0:", ("faults/joints/test_stepping_joints.py",),
    ),
    Mutant(
        "faults/gyroscope.py", "a gyroscope's bias turns", "integral = _centred(total[ends] - total[starts])",
        "integral = total[ends] - total[starts]", ("faults/test_gyroscope.py",),
    ),
    Mutant(
        "faults/gyroscope.py", "small turns never tell", "min(LEAST_TURN, ABOVE_NOISE * float(noise))", "LEAST_TURN",
        ("faults/test_gyroscope.py",),
    ),
    Mutant(
        "signals/footfalls.py", "a lone sample lands a foot", "LONE = 5 ", "LONE = 1 ", ("signals/test_footfalls.py",),
    ),
    Mutant(
        "signals/spikes.py", "landings are spikes", "usual[at] = np.maximum(usual[at], ",
        "usual[at] = np.minimum(usual[at], ", ("signals/test_spikes.py",),
    ),
    Mutant(
        "sensors/below_sensor.py", "landings count as air", "touching, round(LANDING / period)", "touching, 0",
        ("sensors/test_below_sensor.py",),
    ),
    Mutant(
        "sensors/below_sensor.py", "no prior holds what nothing shows", "+ np.eye(len(sizes))",
        "+ 1e-9 * np.eye(len(sizes))", ("sensors/test_below_sensor.py",),
    ),
    Mutant(
        "sensors/newton_euler.py", "what hangs below the sensors moves with the robot",
        "parameters, predicted = parameters - below.parameters, predicted - hangs", "pass",
        ("sensors/test_newton_euler.py", "sensors/test_below_sensor.py", "sensors/moments/test_torque_gains.py"),
    ),
    Mutant(
        "sensors/bandwidth.py", "any slope is a filter", "abs(found.slope) < SURE * found.std", "False",
        ("sensors/test_bandwidth.py",),
    ),
    Mutant(
        "sensors/bandwidth.py", "the other side fades", "1 if found.slope < 0 else -1", "1 if found.slope > 0 else -1",
        ("sensors/test_bandwidth.py",),
    ),
    Mutant(
        "sensors/moments/sensor_turns.py", "a turn that is hardly known is told", "and is_wrong(", "and not is_wrong(",
        ("sensors/moments/test_sensor_turns.py",),
    ),
    Mutant(
        "sensors/moments/sensor_errors.py", "a sensor's place is its turn",
        "place * own + 4 for", "place * own + 1 for", ("sensors/moments/test_sensor_turns.py",),
    ),
    Mutant(
        "faults/bush_frames.py", "joints that stand still turn soles", "if moved > TURNED:", "if moved > 0:",
        ("faults/test_bush_link.py",),
    ),
    Mutant(
        "sensors/attitude_scale.py", "a tilt too small is one too large", "-found[0],", "found[0],",
        ("sensors/test_attitude_scale.py",),
    ),
    Mutant(
        "sensors/attitude_scale.py", "what an attitude drifts by is a scale",
        "without(drift_basis(step * np.arange(len(flat), dtype=np.float64)), flat - flat.mean(axis=0))",
        "flat - flat.mean(axis=0)", ("sensors/test_attitude_scale.py",),
    ),
    Mutant(
        "sensors/attitude_scale.py", "each stance keeps its zero",
        "flat - flat.mean(axis=0)", "flat",
        ("sensors/test_attitude_scale.py",),
    ),
    Mutant(
        "sensors/delays/delays_by_log.py", "logs never differ", "if not (apart >", "if True or not (apart >",
        ("sensors/delays/test_clock_drift.py", "sensors/delays/test_sensor_delay.py"),
    ),
    Mutant(
        "sensors/delays/sensor_delay.py", "encoders that seem late are let be", " and not found.suspect:", ":",
        ("sensors/delays/test_sensor_delay.py",),
    ),
    Mutant(
        "estimation/slow_drift.py", "drift takes a slow motion", "< (1 - QUICK) * beside_line", "< 2 * beside_line",
        ("estimation/test_slow_drift.py",),
    ),
    Mutant(
        "sensors/delays/lagged_log.py", "the stillest stretch is searched", "np.argmax(until[most:]",
        "np.argmin(until[most:]",
        ("sensors/delays/test_lagged_log.py",),
    ),
    Mutant(
        "signals/thinning.py", "quick signals pass for slow ones",
        "low_pass(np.column_stack([read[name] for name in names]), period, cutoff, every=step)",
        "np.column_stack([read[name] for name in names])[::step]", ("signals/test_thinning.py",),
    ),
    Mutant(
        "estimation/least_squares.py", "nuisances stay in the rows",
        "return rows if block.nuisance is None else without(block.nuisance, rows)", "return rows",
        ("estimation/test_least_squares.py",),
    ),
    Mutant(
        "sensors/imu_filter.py", "the gyroscope is read later still", "log.period, found.late)",
        "log.period, -found.late)", ("sensors/test_imu_filter.py",),
    ),
    Mutant(
        "estimation/slow_drift.py", "what is quicker than drift passes for drift", "DRIFT_PERIOD = 20.0",
        "DRIFT_PERIOD = 5.0", ("feet/assess/test_contradiction.py",),
    ),
    Mutant(
        "logs/readers/force_cells.py", "a cell in front of the frame turns the foot the other way",
        "-values @ at[:, 0]", "values @ at[:, 0]", ("logs/readers/test_force_cells.py",),
    ),
    Mutant(
        "robot/weighed.py", "a weighed robot keeps the URDF's moments of inertia",
        "share * inertia.inertia", "inertia.inertia", ("robot/test_weighed.py",),
    ),
    Mutant(
        "sensors/delays/sensor_delay.py", "the delay of force cells is searched for",
        "if on_force_cells(robot, logs):\n        return",
        "if False:\n        return", ("sensors/delays/test_sensor_delay.py",),
    ),
    Mutant(
        "sensors/newton_sides.py", "sensors' errors stay in Newton's law", "(measured - taken)[:, calm]",
        "measured[:, calm]", ("sensors/test_load_errors.py",),
    ),
    Mutant(
        "sensors/load_errors.py", "a sensor may be turned as far as a push asks for", "linalg.inv(_prior(",
        "linalg.inv(1e4 * _prior(", ("sensors/test_load_errors.py",),
    ),
    Mutant(
        "sensors/moments/law_rows.py", "what is missing lost other slow parts than its columns",
        "missing = predicted - np.sum([one.measured for one in read], axis=0)",
        "missing = residual.pair.predicted - residual.pair.measured",
        ("sensors/moments/test_moment_fit.py",),
    ),
    Mutant(
        "sensors/moments/moment_fit.py", "parts that are left out are as good as all",
        "(len(parts) - 1) / len(parts) * (apart", "1 / len(parts) * (apart", ("sensors/moments/test_moment_fit.py",),
    ),
    Mutant(
        "feet/fit/hidden_memory.py", "a memory that is hardly known hides nothing",
        "        both = slice(len(BESIDE))", "        return moved\n        both = slice(len(BESIDE))",
        ("feet/fit/test_hidden_memory.py",),
    ),
    Mutant(
        "feet/assess/data_faults.py", "a push in one log is a fault of all", "(upright and note", "(False and note",
        ("feet/assess/test_data_faults.py",),
    ),
    Mutant(
        "faults/joints/still_joints.py", "a joint that stands alone is at rest", "if doubtful:", "if False:",
        ("faults/joints/test_still_joints.py",),
    ),
    Mutant(
        "faults/joints/still_joints.py", "a spike is a motion", "MOST = (1.0, 99.0)", "MOST = (0.0, 100.0)",
        ("faults/joints/test_still_joints.py",),
    ),
    Mutant(
        "signals/filters.py", "the quickest of the slow cosines stays", "slowest * len(rows) * period) + 1",
        "slowest * len(rows) * period)", ("signals/test_slow_cosines.py",),
    ),
    Mutant(
        "signals/filters.py", "a constant stays", "np.arange(count) * (", "np.arange(1, count + 1) * (",
        ("signals/test_slow_cosines.py",),
    ),
    Mutant(
        "sensors/delays/refined_delays.py", "delays that come and go are as sure as others",
        "np.diag(own.covariance + own.through_time(balances))", "np.diag(own.covariance)",
        ("estimation/delays/test_sensor_delays.py",),
    ),
    Mutant(
        "faults/channels.py", "slow sensors lose frames", "again < 0.5 and longest", "longest",
        ("faults/test_channels.py",),
    ),
    Mutant(
        "sensors/newton_euler.py", "late encoders leave the feet's readings where they are",
        "return np.asarray(predicted - np.sum(carried(transfers, loads.readings), axis=0))", "return predicted",
        ("sensors/test_newton_euler.py",),
    ),
    Mutant(
        "signals/gyroscope_delay.py", "noise makes slow turns look less late", "np.sum(change * turn)",
        "np.sum(change * change)", ("signals/test_gyroscope_delay.py",),
    ),
    Mutant(
        "signals/held.py", "a coarse channel is held", " or coarse(values)", "", ("signals/test_held.py",),
    ),
    Mutant(
        "sensors/imu_filter.py", "logs that disagree show a filter", "mean.apart < AGREE", "True",
        ("sensors/test_imu_filter.py",),
    ),
    Mutant(
        "sensors/accelerometer_delay.py", "the gyroscope tells nothing of the accelerometer",
        "gyroscope is not None and gyroscope.shown and gyroscope.late < LARGEST and std < np.inf", "False",
        ("sensors/test_accelerometer_delay.py",),
    ),
    Mutant(
        "sensors/accelerometer_delay.py", "an orientation drawn to its accelerometer passes for a late one",
        "abs(gyroscope.late) + SHOWN * gyroscope.std < early / 2", "True", ("sensors/test_accelerometer_delay.py",),
    ),
    Mutant(
        "sensors/accelerometer_delay.py", "a late orientation is taken for an early accelerometer",
        "device_delay(told, ORIENTATION)", "(-device_delay(told)[0], device_delay(told)[1])",
        ("sensors/test_accelerometer_delay.py",),
    ),
)  # fmt: skip

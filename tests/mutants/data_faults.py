"""Changes by which a fault of the data, seen before, would go unseen, or a healthy log would have one."""

from __future__ import annotations

from mutant import Mutant

DATA_FAULTS = (
    Mutant(
        "feet/assess/zero_jumps.py", "no jump is far enough", "FAR = 8.0", "FAR = 80.0",
        ("feet/assess/test_zero_jumps.py",),
    ),
    Mutant(
        "feet/assess/zero_jumps.py", "whatever moves is a jump",
        "if most and size > WORTH", "if size > WORTH",
        ("feet/assess/test_zero_jumps.py",),
    ),
    Mutant(
        "feet/assess/zero_jumps.py", "a foot that was lifted has jumped",
        "np.where(same, apart, 0.0)", "apart", ("feet/assess/test_zero_jumps.py",),
    ),
    Mutant(
        "feet/assess/play.py", "play is as large as half of it", "{2e3 * loss", "{1e3 * loss",
        ("feet/assess/test_play.py",),
    ),
    Mutant(
        "feet/assess/play.py", "play need not explain more than the model", "BETTER = 1.5", "BETTER = 0.0",
        ("feet/assess/test_play.py",),
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
        "checks/bush_axes.py", "feet beside each other are before each other",
        "if x > BEFORE * y", "if y > BEFORE * x", ("checks/test_bush_axes.py",),
    ),
    Mutant(
        "checks/log_checks.py", "rows that got lost are bursts",
        "log.period < QUICK * (mean", "log.period < 4 * (mean", ("checks/test_log_checks.py",),
    ),
    Mutant(
        "sensors/moment_fit.py", "another unit hides behind its prior",
        "STRAINED = 2.0", "STRAINED = 200.0", ("sensors/test_moment_balance.py",),
    ),
    Mutant(
        "sensors/moment_balance.py", "a foot is judged by itself where nothing tells it from the other", "APART = 2.0",
        "APART = 200.0", ("sensors/test_moment_balance.py",),
    ),
    Mutant(
        "sensors/moment_balance.py", "no foot is judged by itself", "APART = 2.0", "APART = 0.0",
        ("sensors/test_moment_balance.py",),
    ),
    Mutant(
        "sensors/moment_errors.py", "a walk is as slow as a sway", "    if steps:", "    if False:",
        ("sensors/test_moment_balance.py",),
    ),
    Mutant(
        "sensors/moment_errors.py", "the noise of readings is arms", "share * (noise", "0 * share * (noise",
        ("sensors/test_moment_balance.py",),
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
        "feet/assess/data_faults.py", "feet that carry another weight are believed", '"weight", ', "",
        ("feet/test_identify_faults.py",),
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
        "checks/stepping_joints.py", "one landing is a step", "FEWEST = 2 ", "FEWEST = 1 ",
        ("checks/test_stepping_joints.py",),
    ),
    Mutant(
        "checks/stepping_joints.py", "the other leg may stand as well", "if turned[same] > TURNED:",
        "if turned[same] >= 0:", ("checks/test_stepping_joints.py",),
    ),
    Mutant(
        "checks/gyroscope.py", "a gyroscope's bias turns", "integral = _centred(total[ends] - total[starts])",
        "integral = total[ends] - total[starts]", ("checks/test_gyroscope.py",),
    ),
    Mutant(
        "checks/gyroscope.py", "small turns never tell", "min(LEAST_TURN, ABOVE_NOISE * float(noise))", "LEAST_TURN",
        ("checks/test_gyroscope.py",),
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
        "model_parameters(robot.floating_model) - below.parameters", "model_parameters(robot.floating_model)",
        ("sensors/test_newton_euler.py", "sensors/test_below_sensor.py", "sensors/test_moment_balance.py"),
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
        "feet/assess/data_faults.py", "a filter leaves no stiffness",
        'note.code not in OF_MOMENTS or row.name != "stiffness"', "True", ("feet/assess/test_data_faults.py",),
    ),
    Mutant(
        "sensors/sensor_turns.py", "a turn that is hardly known is told", "and is_wrong(", "and not is_wrong(",
        ("sensors/test_sensor_turns.py",),
    ),
    Mutant(
        "sensors/moment_errors.py", "a sensor's place is its turn", "place * own + 4 for", "place * own + 1 for",
        ("sensors/test_sensor_turns.py",),
    ),
    Mutant(
        "checks/bush_link.py", "joints that stand still turn soles", "if moved > TURNED:", "if moved > 0:",
        ("checks/test_bush_link.py",),
    ),
    Mutant(
        "feet/interval_width/systematic.py", "a delay in doubt counts by its slope alone",
        "if not sensor_delay.doubtful:", "if True:",
        ("feet/interval_width/test_systematic.py",),
    ),
    Mutant(
        "feet/prepare_log.py", "a sensor may repeat itself through a stance",
        "if read < FEWEST_READINGS:", "if read < 0:",
        ("feet/test_steps.py",),
    ),
    Mutant(
        "feet/fit/bush_place.py", "no step shows a turned bush",
        "    if blocks[0].stances is None:\n        return None", "    if True:\n        return None",
        ("feet/test_steps.py",),
    ),
    Mutant(
        "feet/fit/bush_place.py", "a leg that gives way is a turned bush", "STEPS_LEAVE = 0.75", "STEPS_LEAVE = 1e9",
        ("feet/test_steps.py",),
    ),
    Mutant(
        "sensors/attitude_scale.py", "a tilt too small is one too large", "-found[0],", "found[0],",
        ("sensors/test_attitude_scale.py",),
    ),
    Mutant(
        "feet/foot_fit.py", "a scaled attitude takes nothing away", "in (*OF_MOMENTS, ATTITUDE_SCALE)", "in OF_MOMENTS",
        ("sensors/test_attitude_scale.py",),
    ),
    Mutant(
        "sensors/attitude_scale.py", "each stance keeps its zero",
        "signals = signals - signals.mean(axis=0)", "signals = signals",
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
        "feet/assess/zero_jumps.py", "a sole that tips keeps its zero",
        "contact.loaded & ~contact.left_out_for(TIPPING)", "contact.loaded", ("feet/assess/test_zero_jumps.py",),
    ),
    Mutant(
        "feet/foot_fit.py", "a zero that jumps doubts one axis", "jumps.extend(zero_jumps(thin.fitted, fit, shared))",
        "jumps = zero_jumps(thin.fitted, fit, shared)", ("feet/assess/test_zero_jumps.py",),
    ),
    Mutant(
        "feet/fit/bush_place.py", "a guessed height is one for each axis", "above = min(self.above, self.between)",
        "above = self.above", ("feet/fit/test_bush_place.py",),
    ),
    Mutant(
        "feet/fit/bush_place.py", "a shape may turn negative", "shape * np.exp(np.clip(by / shape, -1.0, 1.0))",
        "shape + by", ("feet/fit/test_bush_place.py",),
    ),
    Mutant(
        "feet/fit/bush_place.py", "a wandering angle makes another place", "0.5 * float(np.mean(fit.residuals",
        "0.0 * float(np.mean(fit.residuals", ("feet/fit/test_bush_place.py",),
    ),
    Mutant(
        "feet/fit/regression_data.py", "drift is a line", "drift = drift_beside(deflection, recording.drift(foot))",
        "drift = drift_beside(deflection, recording.drift(foot))[:, :1]", ("feet/fit/test_regression_data.py",),
    ),
    Mutant(
        "estimation/slow_drift.py", "drift takes a slow motion", "< (1 - QUICK) * beside_line", "< 2 * beside_line",
        ("estimation/test_slow_drift.py",),
    ),
    Mutant(
        "feet/memory_of_others.py", "a memory is made up", "s.refused is None and s.model.name in shown), None)",
        "True), None)",
        ("feet/test_memory_of_others.py",),
    ),
    Mutant(
        "feet/memory_of_others.py", "what is not excluded is not said",
        "(excluded and not steps and not small)", "True", ("feet/test_memory_of_others.py",),
    ),
    Mutant(
        "feet/memory_of_others.py", "small motions exclude a memory", "and not steps and not small", "and not steps",
        ("feet/test_memory_of_others.py",),
    ),
    Mutant(
        "feet/fit/worth.py", "a sure spring stands in for an unsure model",
        "bool(far and not low", "bool(False and not low",
        ("feet/fit/test_worth.py",),
    ),
    Mutant(
        "feet/fit/axis_fit.py", "a spring is believed in small motions", "choice.reach < SMALL", "choice.reach < 0.0",
        ("feet/fit/test_axis_fit.py",),
    ),
    Mutant(
        "feet/imu_of_steps.py", "the IMU's turn has no prior", "np.eye(3) / mount**2", "np.eye(3) * mount**2",
        ("feet/test_imu_of_steps.py",),
    ),
    Mutant(
        "feet/imu_of_steps.py", "the IMU's turn is put right twice", "np.array(shown.angles) - ready.imu_turn.angles",
        "np.array(shown.angles)", ("feet/test_imu_of_steps.py",),
    ),
    Mutant(
        "feet/imu_of_steps.py", "no turn is worth it", "(apart > SURE *", "(apart > 1e9 * SURE *",
        ("feet/test_imu_of_steps.py",),
    ),
    Mutant(
        "feet/recording.py", "rates stay where angles are put right", "rate=state.rate + rates", "rate=state.rate",
        ("feet/test_imu_of_steps.py",),
    ),
    Mutant(
        "feet/interval_width/imu_turn.py", "an unknown mount widens nothing", "np.square(effects)",
        "0 * np.square(effects)",
        ("feet/test_imu_of_steps.py",),
    ),
    Mutant(
        "feet/fit/regression_data.py", "a sensor that steps is not turned", "np.inf, 0.006, 0.02",
        "np.inf, 0.006, 1e-9",
        ("feet/test_steps.py",),
    ),
    Mutant(
        "feet/prepare.py", "a log stays when it is checked", "                del log  #",
        "                # del log  #",
        ("feet/test_prepare.py",),
    ),
    Mutant(
        "sensors/delays/lagged_log.py", "the stillest stretch is searched", "np.argmax(until[most:]",
        "np.argmin(until[most:]",
        ("sensors/delays/test_lagged_log.py",),
    ),
    Mutant(
        "model_selection/selection.py", "what hardly slips need not gain", "score.refused or score.held_out_rms <",
        "True or score.held_out_rms <", ("model_selection/test_selection.py",),
    ),
    Mutant(
        "feet/fit/axis_fit.py", "offsets stay of first order",
        "with_best_offsets(unattenuated(fit, recordings, shared), recordings, shared)",
        "unattenuated(fit, recordings, shared)", ("feet/fit/test_bush_place.py",),
    ),
    Mutant(
        "feet/exclusion/edge_rolling.py", "a guessed outline is trusted", "(inner if guessed else 0.0)", "0.0",
        ("feet/exclusion/test_tipping.py",),
    ),
    Mutant(
        "feet/assess/verdicts.py", "a nearer law is said alone", "if evidence.caution is not None:", "if False:",
        ("feet/assess/test_verdicts.py",),
    ),
    Mutant(
        "signals/thinning.py", "quick signals pass for slow ones",
        "low_pass(np.column_stack([read[name] for name in names]), log.period, cutoff)[::step]",
        "np.column_stack([read[name] for name in names])[::step]", ("signals/test_thinning.py",),
    ),
    Mutant(
        "estimation/least_squares.py", "nuisances stay in the rows",
        "return rows if block.nuisance is None else without(block.nuisance, rows)", "return rows",
        ("estimation/test_least_squares.py",),
    ),
    Mutant(
        "signals/gyroscope_delay.py", "the gyroscope is read later still", "log.period, found.late)",
        "log.period, -found.late)", ("signals/test_gyroscope_delay.py",),
    ),
    Mutant(
        "feet/prepare_log.py", "the gyroscope stays late", "with_gyroscope_on_time(even, imu.name)", "even",
        ("feet/test_prepare.py",),
    ),
    Mutant(
        "feet/assess/contradiction.py", "drift contradicts the fit",
        "[beside_drift(row, fitted, by_name[row.motion], predictions, mount) for row in scores]", "scores",
        ("feet/assess/test_contradiction.py",),
    ),
    Mutant(
        "estimation/slow_drift.py", "what is quicker than drift passes for drift", "DRIFT_PERIOD = 20.0",
        "DRIFT_PERIOD = 5.0", ("feet/assess/test_contradiction.py",),
    ),
    Mutant(
        "feet/assess/contradiction.py", "any turn of the IMU is allowed", "np.abs(turned).max() < TURNED * mount",
        "True", ("feet/assess/test_contradiction.py",),
    ),
    Mutant(
        "feet/assess/contradiction.py", "no turn of the IMU is allowed", "np.abs(turned).max() < TURNED * mount",
        "False", ("feet/assess/test_contradiction.py",),
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
        "feet/interval_width/force_gain.py", "a balance is trusted no more than the URDF",
        "if robot.weighed is not None:\n        return robot.uncertainty.total_mass",
        "if False:\n        return robot.uncertainty.total_mass", ("feet/interval_width/test_force_gain.py",),
    ),
    Mutant(
        "sensors/delays/sensor_delay.py", "the delay of force cells is searched for",
        "if any(log.vertical_only(foot.wrench.name) for log in logs for foot in robot.feet.values()):\n        return",
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
        "sensors/moment_errors.py", "what was taken off before is missed for good",
        "pair.predicted - pair.measured - residual.taken", "pair.predicted - pair.measured",
        ("sensors/test_sensor_turns.py",),
    ),
    Mutant(
        "feet/fit/half_turns.py", "half a turn shows a memory", "ROUND = 2.0", "ROUND = 1.0",
        ("feet/fit/test_half_turns.py",),
    ),
)  # fmt: skip

"""Changes in the rooms of feet and estimation by which a fault would go unseen, or a healthy log would have one."""

from __future__ import annotations

from mutant import Mutant

DATA_FAULTS = (
    Mutant(
        "feet/assess/zero_jumps.py", "no jump is far enough", "FAR = 8.0", "FAR = 80.0",
        ("feet/assess/test_zero_jumps.py",),
    ),
    Mutant(
        "feet/assess/zero_jumps.py", "whatever moves is a jump",
        "return left if large and left < (1 - share) * before else None", "return left if large else None",
        ("feet/assess/test_zero_jumps.py",),
    ),
    Mutant(
        "feet/assess/zero_jumps.py", "a loose sensor has one zero",
        "((BESIDE, 1, EXPLAINS), (BRIEF, len(missed), NEARLY_ALL))", "((BESIDE, 1, EXPLAINS),)",
        ("feet/assess/test_zero_jumps.py",),
    ),
    Mutant(
        "feet/assess/late_recordings.py", "any delay within the interval is a fault",
        "fit_blocks(blocks).values[RATE]) < NORMAL95 * wide.std[RATE]",
        "fit_blocks(blocks).values[RATE]) < 0.0", ("feet/assess/test_late_recordings.py",),
    ),
    Mutant(
        "feet/assess/late_recordings.py", "halves of walks that hardly differ are a fault",
        "2 * NORMAL95 * wide.std[RATE]", "0.0", ("feet/assess/test_late_recordings.py",),
    ),
    Mutant(
        "feet/assess/late_recordings.py", "a memory is a late recording",
        "tangent.least_squares.squares < found.squares", "tangent.least_squares.squares < 0.0",
        ("feet/assess/test_late_recordings.py",),
    ),
    Mutant(
        "feet/foot_assessment.py", "numbers of late recordings are usable",
        "        *own,\n", "", ("feet/assess/test_late_recordings.py",),
    ),
    Mutant(
        "feet/assess/play.py", "play is as large as half of it", "Play(2 * loss", "Play(loss",
        ("feet/assess/test_play.py",),
    ),
    Mutant(
        "feet/assess/play.py", "play need not explain more than the model",
        "BETTER * self.squares", "0.0 * self.squares",
        ("feet/assess/test_play.py",),
    ),
    Mutant(
        "feet/place/misread_joints.py", "what is wrong with a joint is told by the worst",
        "key=lambda one: one.squares", "key=lambda one: -one.squares",
        ("feet/place/test_misread_joints.py",),
    ),
    Mutant(
        "estimation/errors_in_variables.py", "all that stances leave is slow",
        "along = squares - sum(", "along = squares - 0.0 * sum(",
        ("feet/interval_width/test_systematic.py",),
    ),
    Mutant(
        "estimation/errors_in_variables.py", "an attitude keeps its angle through a stance",
        "time = 2.0 * place", "time = 0.0 * place",
        ("feet/interval_width/test_systematic.py",),
    ),
    Mutant(
        "feet/interval_width/systematic.py", "rubber that hardens is a sensor that bends",
        "if fit.values[bends] >= 0:", "if fit.values[bends] == 0:",
        ("feet/interval_width/test_systematic.py",),
    ),
    Mutant(
        "feet/interval_width/systematic.py", "the bend is the rubber's whatever the slope is",
        "less * fit.values[1], fit.values[bends]", "less * fit.values[1], 0.0",
        ("feet/interval_width/test_systematic.py",),
    ),
    Mutant(
        "estimation/delays/sensor_delays.py", "cells of a log miss each by themselves",
        "middle += total.T @ total", "middle += sum(scores.T @ scores for scores in own)",
        ("estimation/delays/test_sensor_delays.py",),
    ),
    Mutant(
        "feet/put_right/encoders_of_fits.py", "a law that misses a little is believed",
        "return MISSED_BY_LAW *", "return 0.0 *", ("feet/put_right/test_encoders_of_fits.py",),
    ),
    Mutant(
        "feet/assess/zero_jumps.py", "pieces have no levels of their own",
        "about = products - sums.T @ (sums / counts)", "about = products",
        ("feet/assess/test_zero_jumps.py",),
    ),
    Mutant(
        "feet/place/misread_joints.py", "a soft mount tilts about what pulls at it",
        "cross(up, acceleration)", "acceleration", ("feet/place/test_misread_joints.py",),
    ),
    Mutant(
        "feet/place/misread_joints.py", "a joint that is late is early",
        '("late", "early") if self.size > 0', '("late", "early") if self.size < 0',
        ("feet/place/test_misread_joints.py",),
    ),
    Mutant(
        "feet/place/misread_joints.py", "a joint that moves no number is told",
        "not wide.holds(moved)", "True",
        ("feet/place/test_misread_joints.py",),
    ),
    Mutant(
        "feet/place/misread_joints.py", "play turns with the joint instead of staying behind it",
        "turns = np.tanh(", "turns = -np.tanh(",
        ("feet/place/test_misread_joints.py",),
    ),
    Mutant(
        "feet/place/misread_joints.py", "any joint that explains a little is misread",
        "BETTER, BETTER_TURNING = 1.5, 1.3", "BETTER, BETTER_TURNING = 0.0, 0.0",
        ("feet/place/test_misread_joints.py",),
    ),
    Mutant(
        "feet/prepare_log.py", "an attitude is put right once", "TILT_ROUNDS = 3", "TILT_ROUNDS = 1",
        ("sensors/test_tilt_error.py",),
    ),
    Mutant(
        "feet/interval_width/yaw_zero.py", "a yaw torque's zero that motions show is not believed",
        "if usual and not found.singular:", "if False and not found.singular:",
        ("feet/interval_width/test_systematic.py",),
    ),
    Mutant(
        "feet/assess/data_faults.py", "feet that carry another weight are believed", '"weight", ', "",
        ("feet/test_identify_faults.py",),
    ),
    Mutant(
        "feet/assess/data_faults.py", "a filter leaves no stiffness",
        'note.code not in moments or row.name != "stiffness"', "True", ("feet/assess/test_data_faults.py",),
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
        "feet/place/turned_bush.py", "no step shows a turned bush",
        "    if not tangent.steps:\n        return None", "    if True:\n        return None",
        ("feet/test_steps.py",),
    ),
    Mutant(
        "feet/place/turned_bush.py", "a leg that gives way is a turned bush", "STEPS_LEAVE = 0.75", "STEPS_LEAVE = 1e9",
        ("feet/test_steps.py",),
    ),
    Mutant(
        "feet/foot_assessment.py", "a scaled attitude takes nothing away",
        "in (*OF_MOMENTS, ATTITUDE_SCALE)", "in OF_MOMENTS", ("sensors/test_attitude_scale.py",),
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
        "feet/place/spread.py", "a guessed height is one for each axis", "above = min(self.above, self.between)",
        "above = self.above", ("feet/place/test_bush_place.py",),
    ),
    Mutant(
        "feet/place/bush_place.py", "a shape may turn negative", "shape * np.exp(np.clip(by / shape, -1.0, 1.0))",
        "shape + by", ("feet/place/test_bush_place.py",),
    ),
    Mutant(
        "feet/place/bush_place.py", "a wandering angle makes another place", "0.5 * float(np.mean(fit.residuals",
        "0.0 * float(np.mean(fit.residuals", ("feet/place/test_bush_place.py",),
    ),
    Mutant(
        "feet/regression/regression_data.py", "drift is a line",
        "drift = drift_beside(deflection, recording.drift(foot))",
        "drift = drift_beside(deflection, recording.drift(foot))[:, :1]", ("feet/regression/test_regression_data.py",),
    ),
    Mutant(
        "feet/shared_hysteresis.py", "a memory is made up", "s.refused is None and s.model.name in shown), None)",
        "True), None)",
        ("feet/test_shared_hysteresis.py",),
    ),
    Mutant(
        "feet/shared_hysteresis.py", "what is not excluded is not said",
        "if excluded and not steps and not small:", "if True:", ("feet/test_shared_hysteresis.py",),
    ),
    Mutant(
        "feet/shared_hysteresis.py", "small motions exclude a memory", "and not steps and not small", "and not steps",
        ("feet/test_shared_hysteresis.py",),
    ),
    Mutant(
        "feet/fit/worth.py", "an unsure cube keeps its model", "len(alone) == len(fit.names)", "len(alone) > 0",
        ("feet/fit/test_worth.py",),
    ),
    Mutant(
        "feet/fit/worth.py", "a sure spring stands in for an unsure model",
        "bool(far and not low", "bool(False and not low",
        ("feet/fit/test_worth.py",),
    ),
    Mutant(
        "feet/fit/angle_drift.py", "a drift is the other way round", "-(slow @", "(slow @",
        ("feet/fit/test_angle_drift.py",),
    ),
    Mutant(
        "model_selection/data_sets.py", "a drift stays on the path", "path.deflection - data_set.drift",
        "path.deflection", ("feet/fit/test_angle_drift.py",),
    ),
    Mutant(
        "feet/fit/hidden_memory.py", "a spring is believed in small motions", "choice.reach >= SMALL",
        "choice.reach >= 0.0", ("feet/fit/test_hidden_memory.py",),
    ),
    Mutant(
        "feet/put_right/encoders_of_fits.py", "encoders are read later by all that they are late",
        "late.value - was.encoders", "late.value", ("feet/put_right/test_encoders_of_fits.py",),
    ),
    Mutant(
        "feet/put_right/encoders_of_fits.py", "force sensors stay as late as they were beside other encoders",
        "also = was.follows * more", "also = 0.0", ("feet/put_right/test_encoders_of_fits.py",),
    ),
    Mutant(
        "feet/put_right/imu_of_steps.py", "the IMU's turn has no prior", "np.eye(3) / mount**2", "np.eye(3) * mount**2",
        ("feet/put_right/test_imu_of_steps.py",),
    ),
    Mutant(
        "feet/put_right/imu_of_steps.py", "the IMU's turn is put right twice",
        "np.array(shown.angles) - ready.imu_turn.angles",
        "np.array(shown.angles)", ("feet/put_right/test_imu_of_steps.py",),
    ),
    Mutant(
        "feet/put_right/imu_of_steps.py", "no turn is worth it", "(apart > SHOWN *", "(apart > 1e9 * SHOWN *",
        ("feet/put_right/test_imu_of_steps.py",),
    ),
    Mutant(
        "feet/recording.py", "rates stay where angles are put right", "rate=state.rate + rates", "rate=state.rate",
        ("feet/put_right/test_imu_of_steps.py",),
    ),
    Mutant(
        "feet/interval_width/sensor_causes.py", "an unknown mount widens nothing", "np.sum(effects**2, axis=1)",
        "0 * np.sum(effects**2, axis=1)",
        ("feet/put_right/test_imu_of_steps.py",),
    ),
    Mutant(
        "feet/regression/regression_data.py", "a sensor that steps is not turned", "np.inf, 0.006, 0.02",
        "np.inf, 0.006, 1e-9",
        ("feet/test_steps.py",),
    ),
    Mutant(
        "feet/first_look.py", "a log stays when it is checked", "                del log  #",
        "                # del log  #",
        ("feet/test_prepare.py",),
    ),
    Mutant(
        "model_selection/selection.py", "what hardly slips need not gain", "score.refused or score.held_out_rms <",
        "True or score.held_out_rms <", ("model_selection/test_selection.py",),
    ),
    Mutant(
        "feet/fit/axis_fit.py", "offsets stay of first order",
        "with_best_offsets(unattenuated(fit, recordings, shared), recordings, shared)",
        "unattenuated(fit, recordings, shared)", ("feet/place/test_bush_place.py",),
    ),
    Mutant(
        "feet/exclusion/edge_rolling.py", "a guessed outline is trusted", "(inner if guessed else 0.0)", "0.0",
        ("feet/exclusion/test_tipping.py",),
    ),
    Mutant(
        "feet/assess/verdicts.py", "a nearer law is said alone",
        'return "weak", evidence.doubt, _advice', 'return "usable", evidence.doubt, _advice',
        ("feet/assess/test_verdicts.py",),
    ),
    Mutant(
        "feet/prepare.py", "the gyroscope stays late", "with_gyroscopes_on_time(before, name, imu)", "before",
        ("feet/test_prepare.py",),
    ),
    Mutant(
        "estimation/delays/lag_search.py", "a foot's lag stays on the grid", "Lags(values + beside,", "Lags(values,",
        ("estimation/delays/test_lag_search.py",),
    ),
    Mutant(
        "feet/assess/sensor_hysteresis.py", "hysteresis that moves nothing is told",
        "abs(moved) < PART * NORMAL95 * float(wide.std[RATE])", "False", ("feet/assess/test_sensor_hysteresis.py",),
    ),
    Mutant(
        "feet/interval_width/joint_compliance.py", "joints bend half as much", "axis=1), 1.0)]",
        "axis=1), 0.5)]", ("feet/interval_width/test_joint_compliance.py",),
    ),
    Mutant(
        "feet/assess/contradiction.py", "drift contradicts the fit",
        "[beside_drift(row, fitted, by_name[row.motion], predictions, mount) for row in scores]", "scores",
        ("feet/assess/test_contradiction.py",),
    ),
    Mutant(
        "feet/assess/contradiction.py", "any turn of the IMU is allowed", "np.abs(turned).max() < SHOWN * mount",
        "True", ("feet/assess/test_contradiction.py",),
    ),
    Mutant(
        "feet/assess/contradiction.py", "no turn of the IMU is allowed", "np.abs(turned).max() < SHOWN * mount",
        "False", ("feet/assess/test_contradiction.py",),
    ),
    Mutant(
        "feet/interval_width/force_gain.py", "a balance is trusted no more than the URDF",
        "if robot.weighed is not None:\n        return robot.uncertainty.total_mass",
        "if False:\n        return robot.uncertainty.total_mass", ("feet/interval_width/test_force_gain.py",),
    ),
    Mutant(
        "feet/fit/half_turns.py", "half a turn shows a memory", "ROUND = 2.0", "ROUND = 1.0",
        ("feet/fit/test_half_turns.py",),
    ),
)  # fmt: skip

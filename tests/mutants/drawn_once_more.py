"""Careless changes of what is worked out, not of limits, at places drawn by lot from the rooms that decide numbers."""

from __future__ import annotations

from mutant import Mutant

DRAWN_ONCE_MORE = (
    Mutant(
        "faults/gaps.py",
        "the last dropout for the first",
        "first = int(np.flatnonzero(mask)[0])",
        "first = int(np.flatnonzero(mask)[-1])",
    ),
    Mutant(
        "faults/gyroscope.py",
        "one wild window moves a reading",
        "np.median(np.linalg.norm((turn - self.integral)",
        "np.mean(np.linalg.norm((turn - self.integral)",
    ),
    Mutant(
        "faults/load_signs.py",
        "feet that lift are no loaded ones",
        "np.median(total) > -weight / 2",
        "np.median(total) > weight / 2",
    ),
    Mutant(
        "faults/quaternions.py",
        "turns in the other frame",
        "start - np.cross(start, stop)",
        "start + np.cross(start, stop)",
    ),
    Mutant(
        "feet/assess/zero_jumps.py",
        "a memory looked for beside a memory",
        "if fit.choice is not None and not has_memory(fit.model):",
        "if fit.choice is not None:",
    ),
    Mutant(
        "feet/exclusion/edge_rolling.py",
        "visits to the edge for rest",
        ".all(axis=1) & ~widened(visits, round(SMEAR / period))",
        ".all(axis=1)",
    ),
    Mutant(
        "feet/exclusion/slip.py",
        "soles that roll may slide",
        "contact.standing & ~_not_flat(contact, period) for",
        "contact.standing for",
    ),
    Mutant(
        "feet/exclusion/sole_velocity.py",
        "noise added twice",
        "place = (arm - cross(noise_of_attitude, arm))",
        "place = (arm + cross(noise_of_attitude, arm))",
    ),
    Mutant(
        "feet/exclusion/torque_saturation.py",
        "angles from zero, not from rest",
        "bush.deflection[:, column] - _resting(bush.deflection[used, column])",
        "bush.deflection[:, column]",
    ),
    Mutant(
        "feet/exclusion/torque_saturation.py",
        "ten times as many samples",
        "if used.sum() < 100:",
        "if used.sum() < 1000:",
    ),
    Mutant(
        "feet/fit/compliances.py",
        "a deviation for a variance",
        "prior = (self.alike * self.total) ** 2",
        "prior = self.alike * self.total",
    ),
    Mutant(
        "feet/foot_fit.py",
        "the smallest of what robot files allow",
        "max(each.between_recordings for each in unsure)",
        "min(each.between_recordings for each in unsure)",
    ),
    Mutant(
        "feet/interval_width/yaw_zero.py",
        "zeros pass for recordings that differ",
        "if zeros is not None and zeros.usual:",
        "if zeros is None and False:",
        ("feet/interval_width/test_yaw_zero.py",),
    ),
    Mutant(
        "feet/interval_width/between_recordings.py",
        "what differences do not show is none",
        "shown.share if exact else share_between(sets, resolution(sets)).share",
        "shown.share",
        ("feet/interval_width/test_between_recordings.py",),
    ),
    Mutant(
        "feet/place/bush_place.py",
        "a wandering attitude that places take up is forgotten",
        "wide[: linear.size] = lacking(",
        "_ = lacking(",
        ("feet/place/test_noisy_angles.py",),
    ),
    Mutant(
        "feet/foot_fit.py",
        "a place from steps",
        "set(ROTATIONAL_AXES) <= set(found) and not steps",
        "set(ROTATIONAL_AXES) <= set(found)",
    ),
    Mutant(
        "feet/place/bush_place.py",
        "no doubt of noise",
        "found.covariance[own, own] + np.outer(doubt, doubt), priors",
        "found.covariance[own, own], priors",
    ),
    Mutant(
        "feet/place/spread.py",
        "the wider of two",
        "known = min(self.above, self.between)",
        "known = max(self.above, self.between)",
    ),
    Mutant(
        "feet/regression/model_columns.py",
        "gaps for zeros",
        "columns[~np.isfinite(paths[0].deflection + paths[0].rate)] = np.nan",
        "columns[~np.isfinite(paths[0].deflection + paths[0].rate)] = 0.0",
    ),
    Mutant(
        "feet/regression/model_columns.py",
        "another mount's motion",
        'key = ("motion", foot, axis, imu_turned)',
        'key = ("motion", foot, axis)',
    ),
    Mutant(
        "feet/result.py",
        "one foot for two that never stand together",
        "if len(robot.feet) > 1 and not double:",
        "if not double:",
    ),
    Mutant(
        "fleet/statistics/changes.py",
        "quartiles for deviations",
        "np.median(np.abs(missed))) / 0.6745",
        "np.median(np.abs(missed)))",
    ),
    Mutant(
        "fleet/statistics/control_chart.py", "one tail of two", "-ndtri(outliers / 2)", "-ndtri(outliers)"
    ),
    Mutant(
        "fleet/statistics/trend.py",
        "an exact trend for chance",
        "0.0 if moves else 1.0",
        "1.0 if moves else 0.0",
    ),
    Mutant(
        "inspection/log_summary.py",
        "single support for double",
        "double=period * int(np.sum(contact.support == SUPPORTS.index(DOUBLE)))",
        "double=period * int(np.sum(contact.support == SUPPORTS.index(SINGLE)))",
    ),
    Mutant(
        "model_selection/data_sets.py",
        "samples for seconds",
        "return len(self.response) * self.every * self.motion.period",
        "return len(self.response) * self.every * 1.0",
    ),
    Mutant(
        "sensors/accelerometer_delay.py",
        "the first log's seconds",
        "self.seconds + other.seconds)",
        "self.seconds)",
    ),
    Mutant(
        "sensors/bandwidth.py",
        "the other sensors fade",
        "1 if found.slope < 0 else -1",
        "1 if found.slope > 0 else -1",
    ),
    Mutant(
        "sensors/bandwidth.py",
        "coherence without its square",
        "coherence = np.abs(between) ** 2 /",
        "coherence = np.abs(between) /",
    ),
    Mutant(
        "sensors/delays/lagged_log.py",
        "a force for its square",
        "(LEAST_MOVED * GRAVITY * robot.mass) ** 2",
        "(LEAST_MOVED * GRAVITY * robot.mass)",
    ),
    Mutant(
        "sensors/newton_euler.py",
        "no turns without a gyroscope",
        "if not (turns and accelerates) and log.orientation(imu.name) is None:",
        "if not (turns and accelerates):",
    ),
    Mutant(
        "signals/orientation.py",
        "one sign behind a flip",
        "np.concatenate([[1.0], np.cumprod(flips)])",
        "np.concatenate([[1.0], flips])",
    ),
    Mutant("whole_body/scores.py", "a share for per cent", "relative = 100 * float(", "relative = float("),
)

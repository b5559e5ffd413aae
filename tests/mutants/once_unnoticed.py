"""Changes that no test noticed once. Each has its test now, and stays here so that it keeps it."""

from __future__ import annotations

from mutant import Mutant

INTERVALS = (
    Mutant(
        "feet/interval_width/systematic.py", "the moment arm's deviation is zero",
        "moment_arms), vertical.compliance_std[foot]", "moment_arms), 0.0",
    ),
    Mutant(
        "feet/interval_width/yaw_zero.py", "no cause for the yaw torque's zero",
        'if fit.axis != "roll"', 'if fit.axis != "none"',
    ),
    Mutant(
        "feet/fit/vertical_stiffness.py", "deviation of a reciprocal by the value, not its square",
        "std * value**2", "std * value",
    ),
    Mutant(
        "feet/fit/vertical_stiffness.py", "infinite degrees of freedom where only the sum shows",
        "Compliances(total, 0.0, unseen, float(fit.freedom[0]),", "Compliances(total, 0.0, unseen, np.inf,",
    ),
    Mutant(
        "estimation/delays/sensor_delays.py", "covariance without the sandwich",
        "Delays(values, inverse @ middle @ inverse,", "Delays(values, inverse,",
    ),
    Mutant(
        "estimation/delays/delay.py", "cells that disagree do not widen the delay", "max(1.0, disagreement)", "1.0",
    ),
    Mutant(
        "estimation/blocks.py", "every offset has the first one's deviation",
        "list(self.offsets).index(label)", "0",
    ),
    Mutant(
        "model_selection/variable_projection.py", "a central difference over one step",
        "/ (2 * SHAPE_STEP)", "/ SHAPE_STEP",
    ),
)  # fmt: skip

GUARDS = (
    Mutant(
        "logs/inputs.py", "a recording that is told twice by half is none",
        "return len(asked & there) > max(1, len(asked) / 2)", "return len(asked & there) == len(asked) == PROBES",
        ("logs/test_inputs.py",),
    ),
    Mutant(
        "faults/log_faults.py", "the load along the sensor's own z",
        "(bush.T @ placed)[2] * sensor.sign", "np.array([0.0, 0.0, 1.0]) * sensor.sign",
        ("faults/test_load_signs.py",),
    ),
    Mutant(
        "sensors/moment_errors.py", "the bush's axes taken for the sensor's",
        "np.asarray((bush.T @ sensor)[[1, 0]])", "np.eye(3)[[1, 0]]", ("sensors/test_sensor_errors.py",),
    ),
    Mutant(
        "contact/sole_height.py", "holes reach the samples beside them",
        "np.nan_to_num(by * (deviation / STEP))", "by * (deviation / STEP)", ("contact/test_sole_height.py",),
    ),
    Mutant(
        "model_selection/selection.py", "standard error of the mean taken for that of the sum",
        "np.std(fall) * np.sqrt(len(fall))", "np.std(fall)",
    ),
    Mutant(
        "feet/regression/prediction.py", "an unseen motion's offset from all of it",
        "np.mean((torque - model)[first])", "np.mean((torque - model)[used])",
        tests=("feet/assess/test_scores.py",),
    ),
    Mutant(
        "feet/assess/verdicts.py", "negative damping is not refused", "if evidence.lag:", "if False:",
    ),
    Mutant(
        "feet/assess/verdicts.py", "a further term is never weak",
        '"usable" if width < 2 * USABLE_WIDTH else "weak"', '"usable"',
    ),
    Mutant(
        "feet/exclusion/edge_rolling.py", "samples beside a lean serve",
        "beside & contact.standing, Reason.BESIDE_TIPPING", "beside & False, Reason.BESIDE_TIPPING",
    ),
    Mutant(
        "feet/exclusion/moved_edges.py", "an edge beside a passed one stays where it is",
        "np.where(beyond > 0, 0.0, inwards)", "np.zeros_like(inwards)",
    ),
    Mutant(
        "feet/exclusion/moved_edges.py", "friction is taken for an edge",
        "if _spread(held[:, edge]) < ", "if 0 * _spread(held[:, edge]) < ",
    ),
    Mutant(
        "whole_body/sensor_calibration.py", "a mended channel may spoil other rows",
        "and np.all(after < HARMLESS * before)", "",
    ),
    Mutant(
        "contact/balance.py", "a mass compared with a force", "LOADED * robot.mass * GRAVITY", "LOADED * robot.mass",
    ),
    Mutant(
        "signals/attitude.py", "blended at twice the frequency", "BLEND_FREQUENCY = 0.03", "BLEND_FREQUENCY = 0.06",
    ),
    Mutant(
        "signals/resampling.py", "holes bridged ten times as long", "BRIDGED = 0.04", "BRIDGED = 0.4",
    ),
    Mutant(
        "feet/exclusion/torque_saturation.py", "no bend looked for on the negative side",
        '((1.0, "positive"), (-1.0, "negative"))', '((1.0, "positive"),)',
    ),
    Mutant(
        "dynamics/consistency.py", "off-diagonals packed without the root of two",
        "(1.0 if i == j else np.sqrt(2))", "1.0",
    ),
)  # fmt: skip

NUMBERS_SHOWN = (
    Mutant(
        "dynamics/fit.py", "residual rms over samples, not over equations",
        "residual / np.sqrt(equations)", "residual / np.sqrt(samples)",
    ),
    Mutant(
        "logs/readers/ros/mcap_file.py", "the publisher's time for the recorder's",
        "channel, _, received, _ = message(", "channel, _, _, received = message(",
    ),
    Mutant(
        "report/tables.py", "an offset's deviation shown as half an interval", "NORMAL95 * row.std", "1.0 * row.std",
    ),
    Mutant(
        "report/tables.py", "torques shown as forces", 'Column("mean |error|", "N·m")', 'Column("mean |error|", "N")',
    ),
)  # fmt: skip

ONCE_UNNOTICED = (*INTERVALS, *GUARDS, *NUMBERS_SHOWN)

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
        "logs/same_recording.py", "a recording that is told twice by half is none",
        "return len(asked & there) > max(1, share * len(asked))", "return len(asked & there) == len(asked) == PROBES",
        ("logs/test_inputs.py",),
    ),
    Mutant(
        "faults/log_faults.py", "the load along the sensor's own z",
        "(bush.T @ placed)[2] * sensor.sign", "np.array([0.0, 0.0, 1.0]) * sensor.sign",
        ("faults/test_load_signs.py",),
    ),
    Mutant(
        "sensors/moments/sensor_errors.py", "the bush's axes taken for the sensor's",
        "np.asarray((bush.T @ sensor)[[1, 0]])", "np.eye(3)[[1, 0]]", ("sensors/moments/test_sensor_errors.py",),
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
        "contact/balance.py", "a mass compared with a force", "LIFTING_SHARE * robot.mass * GRAVITY",
        "LIFTING_SHARE * robot.mass",
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

DRAWN_BLINDLY = (
    Mutant(
        "cli/diagnose.py", "a share of 5 % and less is not said",
        "if share > 0.005)",
        "if share > 0.05)",
        ("cli/test_printed_numbers.py",),
    ),
    Mutant(
        "cli/fleet/report.py", "quiet prints",
        "    elif not quiet:\n        print_summary",
        "    else:\n        print_summary",
        ("cli/test_fleet_numbers.py",),
    ),
    Mutant(
        "robot_guess/wrench.py", "most signs turned for fewest",
        "sum(seat.sign < 0 for",
        "sum(seat.sign > 0 for",
        ("robot_guess/test_wrench.py",),
    ),
    Mutant(
        "contact/slip_indicator.py", "turns in the air are twists",
        "known = np.asarray(standing & np.isfinite(heading))",
        "known = np.asarray(np.isfinite(heading))",
        ("contact/test_slip_indicator.py",),
    ),
    Mutant(
        "contact/deflection.py", "onto the sole by a roll the other way",
        "cr * y + sr * level",
        "cr * y - sr * level",
        ("contact/test_deflection.py",),
    ),
    Mutant(
        "contact/phases.py", "phases split where support and reason change at once",
        "!= 0) | (np.diff(self.code)",
        "!= 0) & (np.diff(self.code)",
        ("contact/test_phases.py",),
    ),
    Mutant(
        "report/live.py", "time among the values of a plot's scale",
        "float(columns[1:].min()), float(",
        "float(columns.min()), float(",
        ("report/test_live.py",),
    ),
    Mutant(
        "report/charts/loop.py", "loops of all feet in one chart",
        "for track in tracks if track.foot == foot]",
        "for track in tracks]",
        ("report/charts/test_loop.py",),
    ),
    Mutant(
        "report/page.py", "scripts for styles in the policy",
        "content_policy(script_texts, style_texts),",
        "content_policy(style_texts, script_texts),",
        ("report/test_report.py",),
    ),
    Mutant(
        "whole_body/scores.py", "a joint's residuals without its name",
        'return self.axis or self.joint or ""',
        'return self.axis or ""',
        ("whole_body/test_scores.py",),
    ),
    Mutant(
        "model_selection/model_fit.py", "the first parameter's freedom",
        "float(self.freedom[place]))",
        "float(self.freedom[0]))",
        ("model_selection/test_fit_numbers.py",),
    ),
    Mutant(
        "motions/feasible.py", "the best support of a walk",
        "balance = min(_supports",
        "balance = max(_supports",
        ("motions/test_feasible.py",),
    ),
    Mutant(
        "logs/readers/robot_logger.py", "chunks of a name of any size",
        ' or math.prod(source.chunks or ()) > NAME_LIMIT:\n        raise ValueError("a name',
        ':\n        raise ValueError("a name',
        ("logs/readers/test_read_limit.py",),
    ),
    Mutant(
        "logs/readers/tables/csv_text.py", "blocks of the last line let go",
        "while held - len(behind[0]) >= LINE_LIMIT",
        "while held > LINE_LIMIT",
        ("logs/readers/test_csv_text.py",),
    ),
    Mutant(
        "logs/readers/tables/csv_text.py", "a cut file is broken", "except EOFError:", "except KeyError:",
        ("logs/readers/test_csv_text.py",),
    ),
    Mutant(
        "estimation/random_effects.py", "one group plus each other one",
        "np.eye(len(shares)) - np.eye(len(shares))[place]",
        "np.eye(len(shares)) + np.eye(len(shares))[place]",
        ("estimation/test_random_effects.py",),
    ),
    Mutant(
        "estimation/stance_least_squares.py", "others follow a coefficient the other way",
        "moved = moved + ((keep - 1)",
        "moved = moved - ((keep - 1)",
        ("estimation/test_stance_least_squares.py",),
    ),
    Mutant(
        "estimation/linear.py", "the halves of a walk share stances",
        "stances[len(stances) // 2 :])",
        "stances[len(stances) // 3 :])",
        ("estimation/test_stance_least_squares.py",),
    ),
    Mutant(
        "signals/attitude.py", "the end mirrored at double speed",
        "rest, rest[::-1]])",
        "rest, rest[::-2]])",
        ("signals/test_attitude.py",),
    ),
    Mutant(
        "signals/held.py", "a length that does not fit says nothing",
        "if np.nanmedian(off[held]) > BEYOND_ROUNDING * np.nanmedian(off[~held]):",
        "if False:",
        ("signals/test_held.py",),
    ),
    Mutant(
        "signals/gyroscope_delay.py", "a log's rates differentiated for both",
        "gyroscope_delay(log.angular_velocity(imu), rates_from",
        "gyroscope_delay(rates_from(orientation, log.period), rates_from",
        ("signals/test_gyroscope_delay.py",),
    ),
)  # fmt: skip

ONCE_UNNOTICED = (*INTERVALS, *GUARDS, *NUMBERS_SHOWN, *DRAWN_BLINDLY)

"""Careless changes at places drawn by lot from all rooms, written without a look at the tests."""

from __future__ import annotations

from mutant import Mutant

DRAWN_ANEW = (
    Mutant(
        "campaign/choice.py",
        "as many motions suffice",
        "len(enough.motions) < len(found.compared.motions)",
        "len(enough.motions) <= len(found.compared.motions)",
    ),
    Mutant(
        "campaign/tables.py",
        "a mean of those that did not fall",
        "whole = len(known) == len(mine)",
        "whole = bool(known)",
    ),
    Mutant("faults/gyroscope.py", "half as many windows", "FEWEST_WINDOWS = 20", "FEWEST_WINDOWS = 10"),
    Mutant(
        "faults/gyroscope.py",
        "a turn wrong by less",
        "WRONG_TURN, RIGHT_TURN = 0.8, 0.3",
        "WRONG_TURN, RIGHT_TURN = 0.6, 0.3",
    ),
    Mutant(
        "faults/imu.py",
        "a robot at rest has dead channels",
        "finite.size == 0 or (moves and np.ptp(finite) == 0)",
        "finite.size == 0 or np.ptp(finite) == 0",
    ),
    Mutant(
        "faults/joints/closed_chain.py",
        "more left by the joint's angle",
        "if missed > BETTER or",
        "if missed > 1.4 * BETTER or",
    ),
    Mutant(
        "faults/stance.py",
        "the last foot's force alone",
        'force += np.einsum("nij,ni->nj", axes[k], wrench[:, :3])',
        'force = np.einsum("nij,ni->nj", axes[k], wrench[:, :3])',
    ),
    Mutant(
        "contact/phases.py",
        "the log's begin for a landing",
        "        if run.start > 0:\n            near[run.start",
        "        if run.start >= 0:\n            near[run.start",
    ),
    Mutant(
        "contact/slip_indicator.py",
        "a heading that jumps by a turn",
        "YAW_MOMENT_ARM * np.unwrap(heading[run])",
        "YAW_MOMENT_ARM * heading[run]",
    ),
    Mutant(
        "dynamics/fit.py", "equations of one row", "equations = samples * len(rows)", "equations = samples"
    ),
    Mutant(
        "estimation/delays/bands.py",
        "ends of a quarter of a recording",
        "MOST_ENDS = 0.5",
        "MOST_ENDS = 0.25",
    ),
    Mutant(
        "estimation/stance_least_squares.py",
        "stances' own terms cost no freedom",
        "max(rows - len(problem.products) - problem.common, 1.0)",
        "max(rows - problem.common, 1.0)",
    ),
    Mutant(
        "exporters/contact/springs.py",
        "friction at the whole weight",
        "sum(p.push for p in points) * LOADS[0])",
        "sum(p.push for p in points))",
    ),
    Mutant(
        "exporters/spring.py",
        "an unidentifiable pitch for a rigid one",
        '(axis == "z" and _may_be_rigid(mine["stiffness"]))',
        '_may_be_rigid(mine["stiffness"])',
    ),
    Mutant(
        "exporters/kinetics_observer.py",
        "pitch before roll",
        '"angDamping": ("damping", ("roll", "pitch", None), 12.0)',
        '"angDamping": ("damping", ("pitch", "roll", None), 12.0)',
    ),
    Mutant(
        "feet/assess/contradiction.py",
        "the least contradicting motion",
        "return max(both, key=_share, default=None)",
        "return min(both, key=_share, default=None)",
    ),
    Mutant(
        "feet/assess/parameter_rows.py",
        "a weak angle beside an unidentifiable one",
        'row.verdict in (torque, "unidentifiable")',
        "row.verdict == torque",
    ),
    Mutant(
        "feet/coherent_band.py",
        "drift in a window",
        "part - part.mean(axis=1, keepdims=True) - time[None, :, None] * slope[:, None, :]",
        "part - part.mean(axis=1, keepdims=True)",
    ),
    Mutant(
        "feet/coherent_band.py",
        "the coherence at 0 Hz",
        "low = np.flatnonzero(coherence[1:] < COHERENT)",
        "low = np.flatnonzero(coherence < COHERENT)",
    ),
    Mutant(
        "feet/exclusion/outliers.py",
        "twice the filter's reach",
        "recording.period, 1 / recording.cutoff)",
        "recording.period, 2 / recording.cutoff)",
    ),
    Mutant(
        "feet/exclusion/outliers.py",
        "half as long a neighbourhood",
        "if used.sum() < AROUND / BIN:",
        "if used.sum() < AROUND / BIN / 2:",
    ),
    Mutant(
        "feet/exclusion/sole_velocity.py",
        "noise of a difference",
        "_usual(seen[lag:] - seen[:-lag]) / np.sqrt(2))",
        "_usual(seen[lag:] - seen[:-lag]))",
    ),
    Mutant(
        "logs/readers/ros/topics.py",
        "one layout more",
        "len(self.layouts) >= LAYOUT_LIMIT",
        "len(self.layouts) > LAYOUT_LIMIT",
    ),
    Mutant(
        "logs/readers/streams.py",
        "one stray stamp at most",
        "max(1, STRAY_STAMPS * keep.size)",
        "max(1, STRAY_STAMPS)",
    ),
    Mutant(
        "model_selection/selection.py",
        "an elaboration without terms",
        "== scores[simple].model.name and adds_terms:",
        "== scores[simple].model.name:",
    ),
    Mutant(
        "models/hysteresis.py",
        "no rare slip angles",
        "return size * np.concatenate([usual, rare])[:, None]",
        "return size * usual[:, None]",
    ),
    Mutant("motions/feasible.py", "half the checks", "CHECK_RATE = 50.0", "CHECK_RATE = 25.0"),
    Mutant("motions/feasible.py", "five times the least force", "LEAST = 10.0  # N", "LEAST = 50.0  # N"),
    Mutant("motions/manual.py", "half as much across", "ASIDE = 0.2", "ASIDE = 0.1"),
    Mutant(
        "report/charts/zeros.py",
        "a gap to the wrong side",
        "between = x(begins[1:-1] - gap / 2)",
        "between = x(begins[1:-1] + gap / 2)",
    ),
    Mutant(
        "report/figures/loop.py",
        "a label for each motion",
        "label=label if place == 0 else None)",
        "label=label)",
    ),
    Mutant(
        "results/numbers.py",
        "one digit more before powers",
        "if not -4 <= magnitude < digits + 3:",
        "if not -4 <= magnitude < digits + 4:",
    ),
    Mutant(
        "robot_guess/biped.py",
        "no least depth",
        "depth - LOWEST * max(abs(depth), 0.1)",
        "depth - LOWEST * abs(depth)",
    ),
    Mutant("robot_guess/imu.py", "a turn believed sooner", "CLEARLY = 0.5", "CLEARLY = 0.7"),
    Mutant(
        "robot_guess/stance.py", "a third of the weight", "force > CARRIED * weight", "force > 0.33 * weight"
    ),
    Mutant(
        "sensors/accelerometer_delay.py",
        "the other's share",
        "share = usual**2 / (usual**2 + std**2)",
        "share = std**2 / (usual**2 + std**2)",
    ),
    Mutant(
        "sensors/accelerometer_delay.py",
        "a deviation by the share",
        "std * float(np.sqrt(share))",
        "std * float(share)",
    ),
    Mutant(
        "sensors/accelerometer_delay.py",
        "one foot's place",
        "place = np.mean([foot.sole_position[run, :2] for foot in feet.values()], axis=0)",
        "place = next(iter(feet.values())).sole_position[run, :2]",
    ),
    Mutant(
        "sensors/air_zero.py", "a line through three swings", "FEWEST_FOR_DRIFT = 4", "FEWEST_FOR_DRIFT = 3"
    ),
    Mutant("sensors/air_zero.py", "a drift less clear", "> SHOWN * uncertainty", "> 2.0 * uncertainty"),
    Mutant(
        "sensors/attitude_scale.py",
        "what it is for what it shows",
        "shows {1 / (1 + worst):.3g} times",
        "shows {1 + worst:.3g} times",
    ),
    Mutant(
        "sensors/bandwidth.py",
        "fits better than they can",
        "np.sqrt(max(misfit, 1.0) * np.linalg.inv(normal)[0, 0])",
        "np.sqrt(misfit * np.linalg.inv(normal)[0, 0])",
    ),
    Mutant(
        "sensors/delays/clock_drift.py",
        "over the whole log",
        "abs(share) * longest / 2 < LEAST",
        "abs(share) * longest < LEAST",
    ),
    Mutant(
        "sensors/moments/torque_gains.py",
        "no least gain",
        "usual = max(robot.uncertainty.wrench_gain, LEAST_GAIN)",
        "usual = robot.uncertainty.wrench_gain",
    ),
    Mutant("signals/dropouts.py", "steps ten times as coarse", "FINEST = 1e-7", "FINEST = 1e-6"),
    Mutant("signals/spikes.py", "the mean of a second", "parts = np.median(filled", "parts = np.mean(filled"),
    Mutant(
        "signals/spikes.py",
        "three columns more",
        "and {len(told) - 3} more columns",
        "and {len(told)} more columns",
    ),
    Mutant(
        "whole_body/regularised_fit.py",
        "squares for sizes",
        "return {row: 1 / max(rms, LEAST_ERROR) for",
        "return {row: 1 / max(rms, LEAST_ERROR) ** 2 for",
    ),
    Mutant(
        "whole_body/sensor_calibration.py",
        "before and after exchanged",
        "{after[channel]:.3g} {text}",
        "{before[channel]:.3g} {text}",
    ),
)

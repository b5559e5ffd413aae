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
        "row is not None and _is_all(missed, row, block)", "row is not None",
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
        "sensors/moment_balance.py", "another unit hides behind its prior",
        "STRAINED = 2.0", "STRAINED = 200.0", ("sensors/test_moment_balance.py",),
    ),
    Mutant(
        "sensors/moment_balance.py", "landings are torques too large", "BEYOND_STEPS = 0.4", "BEYOND_STEPS = 0.0",
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
)  # fmt: skip

"""Changes by which what logs of other robots have shown would come back."""

from __future__ import annotations

from mutant import Mutant

OTHER_ROBOTS = (
    Mutant(
        "faults/imu.py",
        "accelerometers that read no gravity are used",
        "return log.without(columns) if odd else log",
        "return log",
        ("faults/test_imu.py", "feet/test_prepare_log.py"),
    ),
    Mutant(
        "faults/channels.py",
        "steps of a converter are lost frames",
        "if jump]",
        "if True]",
        ("faults/test_channels.py",),
    ),
    Mutant(
        "signals/held.py",
        "a robot at rest has stuck sensors",
        "if run.stop - run.start >= least and not _comes_to_rest(steps, run, slow):",
        "if run.stop - run.start >= least:",
        ("signals/test_held.py",),
    ),
    Mutant(
        "signals/held.py",
        "what freezes for good comes to rest",
        "SLOW, BESIDE = 0.3, 5",
        "SLOW, BESIDE = 3.0, 5",
        ("signals/test_held.py",),
    ),
    Mutant(
        "faults/standing.py",
        "exchanged feet have another unit",
        "yield from found if unit else [_swapped()]",
        "yield from found",
        ("faults/test_standing.py",),
    ),
    Mutant(
        "faults/standing.py",
        "another unit is exchanged feet",
        "yield from found if unit else [_swapped()]",
        "yield _swapped()",
        ("faults/test_standing.py",),
    ),
    Mutant(
        "faults/log_faults.py",
        "nobody misses a foot",
        "LEAST_PART, MOST_PART = 0.2, 0.85",
        "LEAST_PART, MOST_PART = 0.2, 0.2",
        ("faults/test_log_faults.py",),
    ),
    Mutant(
        "robot/model.py",
        "four feet are a biped's",
        "MOST_FEET = 2",
        "MOST_FEET = 4",
        ("feet/test_prepare_log.py",),
    ),
    Mutant(
        "feet/fit/vertical_stiffness.py",
        "a force sensor's gain leaves z alone",
        "np.hypot((high - low) / 2 / compliance, gain)",
        "np.hypot((high - low) / 2 / compliance, 0.0)",
        ("feet/fit/test_vertical_stiffness.py",),
    ),
    Mutant(
        "feet/assess/odd_recordings.py",
        "another sign is another floor",
        "FAR = 0.75",
        "FAR = 75.0",
        ("feet/assess/test_odd_recordings.py",),
    ),
    Mutant(
        "feet/validate.py",
        "a fitted log is unseen",
        'if row.role == "fit"',
        'if row.role == "validate"',
        ("feet/test_validate.py",),
    ),
    Mutant(
        "online/verdicts.py",
        "who has a result is sent for one",
        "return [replace(row, advice=AGAIN) if row.advice == IDENTIFY else row for row in found]",
        "return found",
        ("online/test_verdicts.py",),
    ),
    Mutant(
        "exporters/urdf/tree.py",
        "a robot on the world stays there",
        'if self.ends(joint)[0] == "world"]',
        'if self.ends(joint)[0] == "nowhere"]',
        ("exporters/test_urdf_and_sdf.py",),
    ),
    Mutant(
        "feet/result.py",
        "z is usable of faulty logs",
        "standing_faults(ready.fitted)",
        "[]",
        ("feet/assess/test_data_faults.py",),
    ),
)

"""Numbers on their way out: what an export, a range or an option may make of them without a word."""

from __future__ import annotations

from mutant import Mutant

HANDED_ON = (
    Mutant(
        "exporters/spring.py", "an unidentifiable damping goes over as it is",
        'if verdict == "unidentifiable":', 'if verdict == "unknown":', ("exporters/test_not_identified.py",),
    ),
    Mutant(
        "exporters/spring.py", "an assumed damping that the logs exclude",
        "if low > damping:", "if low > 1e9 * damping:", ("exporters/test_not_identified.py",),
    ),
    Mutant(
        "exporters/randomization.py", "an offset's range leaves the IMU's mount out",
        "turned = spring.stiffness * mount", "turned = 0.0 * mount", ("exporters/test_randomization.py",),
    ),
    Mutant(
        "exporters/mjcf/from_urdf.py", "the floor as soft as MuJoCo's own",
        'STIFF = "0.004 1"', 'STIFF = "0.02 1"', ("exporters/test_simulators.py",),
    ),
    Mutant(
        "cli/console/options.py", "seconds taken for milliseconds",
        "if 0 < abs(value) < LEAST_DELAY:", "if 0 < abs(value) < 0.0:", ("cli/test_refusals.py",),
    ),
    Mutant(
        "results/reference.py", "a damping that no log shows among those of other robots",
        'and row.verdict != "unidentifiable"', 'and row.verdict != "unknown"', ("results/test_reference.py",),
    ),
    Mutant(
        "twin/holding_torques.py", "the ground carries nothing",
        "carried[joint] += seat.act(", "carried[joint] += 0.0 * seat.act(", ("comparison/test_compare.py",),
    ),
    Mutant(
        "feet/assess/diagnosis.py", "nearly all, whatever the share",
        "NEARLY_ALL = 0.9", "NEARLY_ALL = 0.0", ("feet/assess/test_diagnosis.py",),
    ),
)  # fmt: skip

"""Careless changes drawn at random over the functions of all rooms that no test running their lines noticed then: each
with its test."""

from __future__ import annotations

from mutant import Mutant

DRAWN_AT_RANDOM = (
    Mutant(
        "cli/design.py",
        "the best set is the smallest one",
        "found.selection.best[-1].motions",
        "found.selection.best[0].motions",
        ("cli/test_ends_of_commands.py",),
    ),
    Mutant(
        "logs/inputs.py",
        "each log may take all the memory",
        "memory=left)",
        "memory=memory)",
        ("logs/readers/test_read_limit.py",),
    ),
    Mutant(
        "twin/presets.py",
        "a sole's normal by a row of its rotation",
        "sole.rotation[:, 2]",
        "sole.rotation[2]",
        ("twin/test_presets.py",),
    ),
    Mutant(
        "cli/demo.py",
        "on a terminal only the steps that take long",
        "if quiet or sys.stderr.isatty():",
        "if quiet:",
        ("cli/test_progress_lines.py",),
    ),
    Mutant(
        "report/dynamics.py",
        "a page of dynamics tells warnings twice and no remarks",
        'notes=kinds(read.notes, "info")',
        'notes=kinds(read.notes, "warning")',
        ("report/test_pages_numbers.py",),
    ),
    Mutant(
        "comparison/tipping.py",
        "a sensor that reads the opposite",
        "foot.wrench.sign * (sole",
        "(sole",
        ("comparison/test_tipping.py",),
    ),
    Mutant(
        "fleet/statistics/changes.py",
        "a day beside too few for a line is none",
        "return True",
        "return False",
        ("fleet/statistics/test_changes.py",),
    ),
    Mutant(
        "report/charts/zeros.py",
        "the first swings alone",
        "rows[:: -(-len(rows) // MOST_SWINGS)]",
        "rows[:MOST_SWINGS]",
        ("report/charts/test_walk_charts.py",),
    ),
    Mutant(
        "logs/readers/ros/topics.py",
        "what no message holds is zero",
        "np.full(sum(map(len, self.header)), np.nan)",
        "np.zeros(sum(map(len, self.header)))",
        ("logs/readers/test_layouts.py",),
    ),
    Mutant(
        "cli/simulate.py",
        "no damping is no bush",
        "0 <= value",
        "0 < value",
        ("cli/test_simulate.py",),
    ),
    Mutant(
        "twin/sensing/logger.py",
        "a joint whose name holds dots is sampled alone",
        '"joint" if column.startswith("joint.") else device_of(column)',
        "device_of(column)",
        ("twin/sensing/test_device.py",),
    ),
    Mutant(
        "results/dynamics_rows.py",
        "a score of zero is left out",
        "if value is not None",
        "if value",
        ("results/test_dynamics.py",),
    ),
    Mutant(
        "cli/console/options.py",
        "less than no delay is one",
        "0 < abs(value) < LEAST_DELAY",
        "0 < value < LEAST_DELAY",
        ("cli/test_refusals.py",),
    ),
    Mutant(
        "design/collision.py",
        "what is fixed to a parent is watched beside its children",
        "in (joints, joints[::-1])",
        "in (joints[::-1],)",
        ("design/test_collision.py",),
    ),
    Mutant(
        "feet/prepare.py",
        "heights by soles that slide",
        "heights_of(robot, flat) if",
        "heights_of(robot, recording) if",
        ("feet/test_prepare.py",),
    ),
)

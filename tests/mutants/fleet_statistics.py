"""Careless changes of what a fleet says together, and of what makes a killed run go on."""

from __future__ import annotations

from mutant import Mutant

FLEET = (
    Mutant(
        "fleet/cluster.py", "workers elsewhere get paths that are relative to here",
        "else os.path.abspath(place)", "else place",
    ),
    Mutant(
        "fleet/statistics/random_effects.py", "the normal's interval instead of Student's",
        "0.975, freedom if freedom > 0 else np.inf", "0.975, np.inf",
    ),
    Mutant(
        "fleet/statistics/random_effects.py", "days are not pooled before robots",
        "_between(day_values, day_squares, unit_of)",
        "_between(day_values, day_squares, np.zeros(len(unit_of), dtype=int))",
    ),
    Mutant(
        "fleet/statistics/trend.py", "one degree of freedom too many",
        "freedom = len(time) - 2", "freedom = len(time) - 1",
    ),
    Mutant(
        "fleet/statistics/control_chart.py", "the baseline's own uncertainty forgotten",
        "(1 / weight + 1 / total)", "(1 / weight)",
    ),
    Mutant(
        "fleet/statistics/control_chart.py", "a day may count towards a step without limit",
        "min(max(number, -CLIP), CLIP)", "number",
    ),
    Mutant(
        "fleet/statistics/control_chart.py", "limits of one side for two",
        "length = 2 / steps", "length = 1 / steps",
    ),
    Mutant(
        "fleet/statistics/control_chart.py", "an outlier joins the baseline",
        "                continue\n", "                pass\n",
    ),
    Mutant(
        "fleet/statistics/changes.py", "each kind takes the whole rate",
        "probability = min(rate / KINDS /", "probability = min(rate /",
    ),
    Mutant(
        "fleet/statistics/changes.py", "drifts are steps",
        "    if not of_line < of_levels", "    if of_line < of_levels",
    ),
    Mutant(
        "fleet/series.py", "values are not in time's order",
        "np.lexsort((times, which))", "np.lexsort((values, which))",
    ),
    Mutant(
        "fleet/unit.py", "settings do not count for the key", '"settings": settings.to_dict(),', '"settings": {},',
        tests=("fleet/test_run.py",),
    ),
    Mutant(
        "fleet/work.py", "a log that does not fit is kept as broken",
        "        except Passing:\n            raise\n", "",
        tests=("fleet/test_run.py",),
    ),
    Mutant(
        "fleet/summary.py", "each series takes the robot's whole rate",
        "false_alarms / max(of_unit[one.unit], 1)", "false_alarms",
        tests=("fleet/test_summary.py",),
    ),
)  # fmt: skip

"""Which recordings tell most about each parameter, alone and together (information matrices of eq. 6 and 7)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import comb

import numpy as np

from plantar.choices import settings_of
from plantar.conventions import NORMAL95, ROTATIONAL_AXES, Array
from plantar.cores import blas_on_one_core
from plantar.errors import DataError
from plantar.estimation import fit_blocks
from plantar.estimation.residual_covariance import cosine_covariance
from plantar.feet.prepare import prepare_all
from plantar.feet.regression.regression_data import blocks_of
from plantar.feet.settings import FeetSettings
from plantar.logs.inputs import LogInputs, RobotInput, check_names, logs_of, robot_of
from plantar.models import KelvinVoigt

SEVERAL = 3000  # combinations looked at one by one; beyond that the best set grows one recording at a time
UNKNOWN = 1000.0  # %: stands for a parameter that a set does not identify

Key = tuple[str, str, str]  # foot, axis, term


@dataclass(frozen=True)
class MotionInformation:
    """What one recording adds for one foot and axis: `information` (2, 2) and the covariance of its `scores` (2, 2)."""

    information: Array
    scores: Array


@dataclass(frozen=True)
class Choice:
    """A set of recordings and the 95 % half width that it promises for each parameter, in percent of its value.

    `condition_number` is the worst of the scaled information matrices; `worst` the largest half width.
    """

    motions: tuple[str, ...]
    half_width_percent: dict[Key, float]
    condition_number: float

    @property
    def worst(self) -> float:
        return max(self.half_width_percent.values())

    @property
    def usual(self) -> float:
        """Geometric mean of the half widths: what ranks sets."""
        return float(np.exp(np.mean(np.log(list(self.half_width_percent.values())))))


@dataclass(frozen=True)
class Selection:
    """Every recording alone, the best set of each size, all together, and a set named by the caller."""

    alone: tuple[Choice, ...]
    best: tuple[Choice, ...]
    together: Choice
    compared: Choice | None


@blas_on_one_core()
def select_motions(
    robot: RobotInput,
    logs: LogInputs,
    compare: Sequence[str] = (),
    largest: int = 6,
    settings: FeetSettings | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Selection:
    """Rank single recordings and sets of them by the intervals that they promise.

    Args:
        robot: a robot with feet, or the path of its robot file.
        logs: logs to choose from, or their paths.
        compare: names of motions to set beside the best.
        largest: most recordings in a set.
        settings: as for `identify_feet`.
        progress: called with a line for each step.

    Returns:
        Every recording alone, the best set of each size, all together, and `compare`: 95 % half widths [% of the
        value] by foot, axis and term.

    Raises:
        RobotError, LogError: a file that cannot be read. DataError: a name in `compare` is unknown, or nothing can be
        fitted.

    Example:
        >>> import plantar
        >>> found = plantar.select_motions("robot.yaml", ["sway_1.csv", "sway_2.csv"], largest=2)
        >>> [len(choice.motions) for choice in found.best]
        [1, 2]
    """
    robot = robot_of(robot)
    logs = tuple(logs_of(logs, robot))
    settings = settings_of(settings, FeetSettings)
    check_names(logs)
    names = [log.name for log in logs]
    unknown = [name for name in compare if name not in names]
    if unknown:
        raise DataError(f"no log is called '{unknown[0]}' (valid: {', '.join(names)})")
    recordings = prepare_all(robot, logs, (), settings, progress).fitted
    gained: dict[tuple[str, str], dict[str, MotionInformation]] = {}
    values: dict[Key, float] = {}
    for foot in robot.feet:
        for axis in ROTATIONAL_AXES:
            blocks = blocks_of(recordings, foot, axis)
            if not blocks:
                continue
            fit = fit_blocks(blocks)
            for term, value in zip(KelvinVoigt().terms, fit.values, strict=True):
                values[foot, axis, term] = float(value)
            gained[foot, axis] = {}
            for block in blocks:
                centred = block.regressor - block.regressor.mean(axis=0)
                scores = cosine_covariance(centred * fit.residuals[block.label][:, None], block.duration)[0]
                gained[foot, axis][block.label] = MotionInformation(centred.T @ centred, scores)
    if not values:
        raise DataError(
            "no log has samples of a standing foot that can be used (valid: a robot that stands on its feet)"
        )
    choices = {(name,): _promise((name,), gained, values) for name in names}
    best = _best_sets(names, largest, lambda motions: _promise(motions, gained, values))
    return Selection(
        alone=tuple(sorted(choices.values(), key=lambda choice: choice.usual)),
        best=tuple(best),
        together=_promise(tuple(names), gained, values),
        compared=_promise(tuple(compare), gained, values) if compare else None,
    )


def _promise(
    motions: tuple[str, ...],
    gained: dict[tuple[str, str], dict[str, MotionInformation]],
    values: dict[Key, float],
) -> Choice:
    """Expected half widths of a set: sandwich of the summed information and scores."""
    widths: dict[Key, float] = {}
    condition = 1.0
    for (foot, axis), parts in gained.items():
        present = [parts[motion] for motion in motions if motion in parts]
        information = np.sum([part.information for part in present], axis=0) if present else np.zeros((2, 2))
        scale = np.sqrt(np.diag(information))
        regular = bool(np.all(scale > 0))
        scaled = information / np.outer(scale, scale) if regular else np.eye(2)
        condition = max(condition, float(np.linalg.cond(scaled)) if regular else np.inf)
        if not regular or np.linalg.cond(scaled) > 1e10:
            widths.update({(foot, axis, term): UNKNOWN for term in KelvinVoigt().terms})
            continue
        inverse = np.linalg.inv(information)
        covariance = inverse @ np.sum([part.scores for part in present], axis=0) @ inverse
        for term, variance in zip(KelvinVoigt().terms, np.diag(covariance), strict=True):
            value = values[foot, axis, term]
            width = 100 * NORMAL95 * float(np.sqrt(variance)) / abs(value) if value else UNKNOWN
            widths[foot, axis, term] = min(width, UNKNOWN)
    return Choice(motions, widths, condition)


def _best_sets(
    names: Sequence[str], largest: int, promise: Callable[[tuple[str, ...]], Choice]
) -> list[Choice]:
    """The best set of each size: all sets where they are few, else the previous best and one more."""
    best: list[Choice] = []
    for size in range(1, min(largest, len(names)) + 1):
        sets = list(combinations(names, size)) if comb(len(names), size) <= SEVERAL else [
            (*best[-1].motions, name) for name in names if name not in best[-1].motions
        ]  # fmt: skip
        best.append(min((promise(motions) for motions in sets), key=lambda choice: choice.usual))
    return best

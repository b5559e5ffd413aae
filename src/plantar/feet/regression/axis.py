"""The fitted model of one axis of one foot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple, Self

import numpy as np

from plantar.conventions import NORMAL95, Array, Axis
from plantar.estimation import interval95
from plantar.model_selection.selection import ModelChoice
from plantar.models import BushModel
from plantar.notes import Note

WORTH = 0.01  # of stiffness or damping: less matters to nobody, even of logs without noise


class AngleDrift(NamedTuple):
    """What is off a memory's path, `angle` (n,) [rad] at times `time` (n,) [s] of a recording: see `angle_drift`."""

    time: Array
    angle: Array

    def at(self, time: Array) -> Array:
        """The angle at other times (N,)."""
        return np.interp(time, self.time, self.angle)


@dataclass(frozen=True, kw_only=True)
class FittedModel:
    """What a fit predicts one axis of one foot by: `values` (k,) as `model.terms`, `shape` (s,) as `model.shape_terms`.

    `moment_arms` [m]: by how much the bush's centre is aside and above its place; `turned` [rad]: by how much the
    force sensor is turned about the vertical, so that the other axis' torque shows in this one; `leans` [rad]: about
    the other axis, so that the yaw torque does; `crosstalk` [N.m/N]: of the horizontal force that turns the
    other axis; `imu_turned` [rad]: the turn about each of the IMU's axes that puts its angles right, as far as that
    shows while joints between it and the foot move.
    Of the recordings that were fitted: `offsets` [N.m], `initial_states` of the model's memory in each recording's
    runs, and the `drifts` that its path is without.
    """

    foot: str
    axis: Axis
    model: BushModel
    values: Array
    shape: Array
    moment_arms: tuple[float, float] = (0.0, 0.0)
    turned: float = 0.0
    leans: float = 0.0
    crosstalk: float = 0.0
    imu_turned: tuple[float, float, float] = (0.0, 0.0, 0.0)
    offsets: Mapping[str, float] = field(default_factory=dict)
    initial_states: Mapping[str, Array] = field(default_factory=dict)
    drifts: Mapping[str, AngleDrift] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        return (*self.model.terms, *self.model.shape_terms)

    @property
    def place(self) -> Array:
        """`moment_arms`, `turned`, `leans` and `crosstalk`, as the columns of steps take them, (5,)."""
        return np.array([*self.moment_arms, self.turned, self.leans, self.crosstalk])

    @property
    def slip_angle(self) -> float | None:
        """The angle at which an element of the model slips [rad]; None of a model without one."""
        terms = self.model.shape_terms
        return float(self.shape[terms.index("slip_angle")]) if "slip_angle" in terms else None

    def at_place(self, place: Array) -> Self:
        """The same about another `place` (5,)."""
        aside, above, turned, leans, crosstalk = place.tolist()
        return replace(self, moment_arms=(aside, above), turned=turned, leans=leans, crosstalk=crosstalk)

    @property
    def numbers(self) -> Array:
        """Values and shape, (k + s,)."""
        return np.concatenate([self.values, self.shape])


@dataclass(frozen=True, kw_only=True)
class AxisFit(FittedModel):
    """A fitted model and how well it is known: `covariance`, `freedom` and `white_std` run over values and shape.
    `equivalent`: K and C of spring and damper over the same motions; `hidden_share`: of the stiffness, that a memory
    would make which other axes of the robot show and this one's motions do not exclude. `place_std`: of `moment_arms`,
    `turned` and `imu_turned`, None where nobody knows; `place_variance`: what these add to the variances, by cause."""

    covariance: Array
    freedom: Array
    white_std: Array
    offset_std: Mapping[str, float]
    equivalent: tuple[float, float]
    choice: ModelChoice | None
    reason: str
    notes: tuple[Note, ...] = ()
    hidden_share: float = 0.0
    place_std: tuple[float | None, ...] = (None,) * 6
    place_variance: Mapping[str, Array] = field(default_factory=dict)

    @property
    def std(self) -> Array:
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    def interval(self, place: int) -> tuple[float, float]:
        """The 95 % interval of one of the `numbers`."""
        return interval95(float(self.numbers[place]), float(self.std[place]), float(self.freedom[place]))

    def holds(self, moved: Array) -> bool:
        """Whether stiffness and damping that are `moved` (2,) stay within their intervals, or nearly where they are."""
        inside = np.maximum(NORMAL95 * self.std[:2], WORTH * np.abs(self.values[:2]))
        return bool((np.abs(moved) <= inside).all())

"""Gains of the torque channels: what the feet's torques must be for the robot to move as it does.

A torque that reads a tenth too large makes stiffness and damping a tenth too large, and nothing in a foot's own torque
and angle shows it. The whole body does: forces, torques and their places must give the moments of eq. 1's base rows.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy import special

from plantar.conventions import ROTATIONAL_AXES, Array, Axis
from plantar.dynamics import Contact, Equation
from plantar.estimation.intervals import cosine_covariance
from plantar.notes import Note
from plantar.robot.model import Foot, RobotModel
from plantar.sensors.newton_euler import BASE_ROWS, CUTOFF, SLOW, NewtonEulerResidual
from plantar.signals.filters import low_pass

LOOSE = 0.3  # share: deviation of a torque's gain before the moments are asked
LEAST_GAIN = 0.01  # share, of the forces' gains and of what their places add: nuisances need a finite prior
LEAST_ARM = 0.003  # m, likewise
BAND = 2.0  # Hz: the robot moves below it, and most of the sensors' noise is above
MOUNT = 0.1  # rad, by which sensors and IMU may be turned: wide, so that no turned mount passes for a gain
CHANCE = 0.01  # that torques without a fault are called wrong about an axis, by deviations that are on the safe side
OPPOSED = 0.1  # share: feet that are off by more, each the other way, are rather another fault's trace
OPPOSED_LIMIT = 2.0  # times what chance allows: beyond it gains are wrong, whichever foot's
WORTH_SAYING = 0.03  # share: what the force sensors' makers promise is seldom better


class TorqueGain(NamedTuple):
    """By which `shares` each foot's torque about an axis reads too much, and the `std` of their mean.

    What belongs to which foot is known far worse than the mean: both feet turn alike.
    """

    shares: Mapping[str, float]
    std: float

    @property
    def mean(self) -> float:
        return float(np.mean(list(self.shares.values())))

    @property
    def opposed(self) -> bool:
        """Whether one foot's torque reads far too much and another's far too little."""
        return min(self.shares.values()) < -OPPOSED and max(self.shares.values()) > OPPOSED

    @property
    def reach(self) -> float:
        """By which share any foot's torque may be off."""
        return max(map(abs, self.shares.values()))


@dataclass(frozen=True)
class _Sides:
    """One log's columns (k, n, 6) and what they must add up to (n, 6); `drawn` (draws, n, 6): of a wrong URDF.

    Slower than BAND; `fast` (k + 1, n, 6) are columns and what is missing above it.
    """

    columns: Array
    missing: Array
    drawn: Array
    fast: Array
    period: float


def torque_gains(robot: RobotModel, residuals: Sequence[NewtonEulerResidual]) -> dict[Axis, TorqueGain]:
    """The torques' gains about each axis about which the moments do not balance with gains as they should be.

    A generalised least-squares fit of what Newton's law misses to each foot's torques, beside the forces' gains and
    places, which may be off by what the robot file says; the deviation holds coloured noise and a wrong URDF.
    """
    if not residuals:
        return {}
    sides, feet = [_sides(robot, residual) for residual in residuals], len(robot.feet)
    values, covariance = (part[..., : 2 * feet] for part in _solved(sides, _prior(robot)))
    usual = covariance[: 2 * feet] + robot.uncertainty.wrench_gain**2 * np.eye(2 * feet)
    gains, beyond, draws = {}, {}, len(sides[0].drawn)
    for place, axis in enumerate(ROTATIONAL_AXES):
        mine = slice(place * feet, (place + 1) * feet)
        shares = dict(zip(robot.feet, (-values[mine] / (1 + values[mine])).tolist(), strict=True))
        gains[axis] = TorqueGain(shares, float(np.sqrt(covariance[mine, mine].sum())) / feet)
        beyond[axis] = _beyond_chance(values[mine], usual[mine, mine], draws)
    # One foot's torques that are off about both axes show less about each than about both together.
    if max(beyond.values()) <= 1 and not any(gain.opposed for gain in gains.values()):
        beyond = dict.fromkeys(gains, _beyond_chance(values, usual, draws))
    return {
        axis: gain
        for axis, gain in gains.items()
        if beyond[axis] > (OPPOSED_LIMIT if gain.opposed else 1) and abs(gain.mean) > WORTH_SAYING
    }


def _beyond_chance(values: Array, usual: Array, draws: int) -> float:
    """How many times larger gains (k,) are than a covariance (k, k) from so many `draws` lets them be by chance."""
    distance = float(values @ np.linalg.solve(usual, values)) / len(values)
    freedom = max(draws - len(values), 2) if draws else 1e9
    return distance / float(special.fdtri(len(values), freedom, 1 - CHANCE))


def torque_gain_notes(gains: Mapping[Axis, TorqueGain]) -> dict[Axis, Note]:
    """A warning for each axis about which the feet's torques cannot be right."""
    notes = {}
    for axis, gain in gains.items():
        each = ", ".join(f"{foot} {100 * share:+.0f} %" for foot, share in gain.shares.items())
        text = (
            f"{axis}: the feet's torques do not give the moments that the robot's motion needs: they read "
            f"{100 * gain.mean:+.0f} ± {196 * gain.std:.0f} % too much on average (95 %; most likely {each}), and "
            "stiffness and damping follow them. Check unit and calibration of the torque channels"
        )
        notes[axis] = Note("torque_gain", "warning", text)
    return notes


def _prior(robot: RobotModel) -> Array:
    """Deviations of the columns of `_sides`: torques of both axes; of each foot its gain, moment arms and turns; the
    IMU's mount.
    """
    uncertainty, feet = robot.uncertainty, len(robot.feet)
    gain = max(uncertainty.wrench_gain, LEAST_GAIN)
    arm = max(float(np.hypot(uncertainty.bush_position, uncertainty.wrench_crosstalk)), LEAST_ARM)
    return np.concatenate(
        [
            np.full(2 * feet, LOOSE),
            np.tile([gain, arm, arm, arm, MOUNT, MOUNT, MOUNT], feet),
            np.full(3, MOUNT),
        ]
    )


def _sides(robot: RobotModel, residual: NewtonEulerResidual) -> _Sides:
    pair, equation = residual.pair, Equation(robot.floating_model)
    torques: list[list[Array]] = [[], []]
    others = []
    for place, foot in enumerate(robot.feet.values()):
        force, torque = np.split(residual.readings[:, 6 * place : 6 * place + 6], 2, axis=1)
        contact = Contact(*robot.frame(foot.wrench.placement))
        transfer = equation.contact_transfer(residual.motion.positions, contact)[:, BASE_ROWS]
        # Each axis' torque alone; the whole wrench; the force on an arm along x, y and z; the wrench turned about them.
        alone = [np.hstack([0 * force, np.outer(torque @ along, along)]) for along in _directions(foot)]
        moved = [np.hstack([0 * force, np.cross(arm, force)]) for arm in np.eye(3)]
        turned = [np.hstack([np.cross(turn, force), np.cross(turn, torque)]) for turn in np.eye(3)]
        carried = [
            np.einsum("nij,nj->ni", transfer, wrench)
            for wrench in (*alone, np.hstack([force, torque]), *moved, *turned)
        ]
        for own, column in zip(torques, carried[:2], strict=True):
            own.append(column)
        others += carried[2:]
    moving = _moving(np.stack([*torques[0], *torques[1], *others, *-residual.by_mount]), pair.period)
    drawn = pair.model_errors.reshape(-1, *moving.shape[1:])
    every = np.concatenate([moving, [pair.predicted - pair.measured], drawn])
    slow, count = _low_passed(every, pair.period, BAND), len(moving)
    fast = (every - slow)[: count + 1]
    return _Sides(slow[:count], slow[count], slow[count + 1 :], fast, pair.period)


def _directions(foot: Foot) -> Array:
    """The bush's pitch and roll axes in the force sensor's frame, (2, 3)."""
    same = foot.bush.link == foot.wrench.placement.link
    turn = foot.wrench.placement.rotation.T @ foot.bush.rotation if same else np.eye(3)
    return np.asarray(turn.T[[1, 0]])


def _moving(columns: Array, period: float) -> Array:
    """Columns (k, n, 6) without what postures and drifting zeros do to them."""
    return columns - _low_passed(columns, period, SLOW)


def _low_passed(columns: Array, period: float, cutoff: float) -> Array:
    """Columns (k, n, 6) through a low-pass."""
    rows = columns.transpose(1, 0, 2).reshape(columns.shape[1], -1)
    return np.asarray(low_pass(rows, period, cutoff).reshape(len(rows), -1, 6).transpose(1, 0, 2))


def _products(side: _Sides, weights: Array) -> Array:
    """Products (k + 1, k + 1) of columns and what is missing, without what the sensors' noise adds to them.

    The feet's own readings are in the columns and in what is missing: their noise, multiplied with itself, would pass
    for arms of centimetres. It is as large below BAND as it is above, where hardly anything else is.
    """
    slow = np.concatenate([side.columns, [side.missing]])
    noise = BAND / (CUTOFF - BAND) * np.einsum("inc,jnc,c->ij", side.fast, side.fast, weights)
    return np.asarray(np.einsum("inc,jnc,c->ij", slow, slow, weights) - noise)


def _positive(products: Array) -> Array:
    """The nearest products (k, k) that real columns can have: noise taken off may leave less than nothing."""
    sizes, vectors = np.linalg.eigh(products)
    return np.asarray((vectors * np.maximum(sizes, 0.0)) @ vectors.T)


def _solved(sides: Sequence[_Sides], prior: Array) -> tuple[Array, Array]:
    """Coefficients of the columns, those of torques first, and their covariance."""
    values, known = np.zeros(len(prior)), np.diag(prior**-2.0)
    for _ in range(2):  # weights from what is left, then the coefficients once more
        left = [side.missing - np.tensordot(values, side.columns, 1) for side in sides]
        # A filtered signal has two independent samples in a period of its cutoff.
        weights = 2 * BAND * sides[0].period / np.mean(np.vstack(left) ** 2, axis=0)
        both = np.sum([_products(side, weights) for side in sides], axis=0)
        normal = _positive(both[:-1, :-1]) + known
        values[:] = np.linalg.solve(normal, both[:-1, -1])
    inverse, scatter = np.linalg.inv(normal), known.copy()
    moved: Array = np.zeros((len(prior), len(sides[0].drawn)))
    for side in sides:
        missed = side.missing - np.tensordot(values, side.columns, 1)
        scores = np.sum(side.columns * (missed * weights), axis=2).T
        scatter += cosine_covariance(scores, len(scores) * side.period)[0]
        if moved.size:
            weighted = (side.columns * weights).reshape(len(prior), -1)
            moved += inverse @ weighted @ side.drawn.reshape(len(side.drawn), -1).T
    return values, inverse @ scatter @ inverse + moved @ moved.T / max(moved.shape[1], 1)

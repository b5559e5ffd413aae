"""Where the bush's centre is, beside the robot file's place: standing motions show it, as steps do.

A centre that is aside makes a torque that grows with the load, one that is higher a torque that grows with the
horizontal force; where the force sensor or the IMU is turned about the vertical, the other axis' torque shows; where
the IMU is turned about any axis, so do the joints between it and the foot. All are
columns beside the model's, with the robot file's uncertainty as a prior: logs that show the place sharply outweigh it,
logs that do not leave it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import Array, Mask
from plantar.estimation import Block, effect_of, fit_blocks
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.regression_data import blocks_of, place_columns
from plantar.feet.recording import Recording
from plantar.notes import Note
from plantar.robot.model import RobotModel

GUESSED = 0.02  # m: what a guess without a spread of its own may be off by
CLEAR = 3.0  # deviations of prior and data together, beyond which the robot file's place is called wrong
FARTHEST = np.array(
    [0.05, 0.05, *[0.12] * 4]
)  # m, m, rad: what is still corrected without doubting all the rest
FAR = "bush_place_far"
WORTH_SAYING = 0.005  # m: a centre that is nearer to its place is within what drawings get wrong
TURN_WORTH_SAYING = 0.02  # rad: of a mount, likewise
UNSEEN = 1e-4  # of the torque's rms: what one deviation of a place adds beside it is as good as nothing
SINGULAR = 1e6  # condition of the fit beyond which the motions do not show the place


@dataclass(frozen=True)
class PlaceSpread:
    """Deviation of the centre's place, `aside` and `above` [m], of how far a sensor is `turned` in yaw [rad], and the
    IMU about each of its axes."""

    aside: float
    above: float
    turned: float
    imu: float

    @property
    def deviations(self) -> Array:
        """In the order of `place_columns`, (6,)."""
        return np.array([self.aside, self.above, self.turned, *[self.imu] * 3])

    @classmethod
    def of(cls, robot: RobotModel, foot: str) -> PlaceSpread:
        """From the robot file: its uncertainty, and what its guesses of bush and force sensor may be off by."""
        if robot.feet[foot].contact == "always":  # its sensor was zeroed under load: the load is not known
            return cls(0.0, 0.0, 0.0, 0.0)
        position = robot.uncertainty.bush_position
        for guess in robot.guesses:
            if guess.key.startswith((f"feet.{foot}.bush", f"feet.{foot}.wrench")):
                position = max(position, GUESSED if guess.spread is None else guess.spread)
        aside = float(np.hypot(position, robot.uncertainty.wrench_crosstalk)) if position else 0.0
        mount = robot.uncertainty.imu_mount
        return cls(aside, position, mount, mount)


def about_its_place(
    fit: AxisFit, recordings: Sequence[Recording], spread: PlaceSpread, shared: bool
) -> AxisFit:
    """The fit of a standing foot about where its centre is, widened by what that leaves unknown.

    A foot that steps has its centre from its stances already.
    """
    blocks = blocks_of(recordings, fit.foot, fit.axis, drift=not shared, fit=fit)
    spreads = spread.deviations
    if blocks[0].stances is not None or not spreads.any():
        return fit
    by_name = {one.name: one for one in recordings}
    columns = [
        place_columns(by_name[block.label], fit.foot, fit.axis, float(fit.values[0]))[
            by_name[block.label].used(fit.foot)
        ]
        for block in blocks
    ]
    spreads = np.where(_seen(blocks, columns, spreads), spreads, 0.0)
    size, tried = len(fit.values), np.flatnonzero(spreads)
    found = fit_blocks(
        [_beside(block, own[:, tried]) for block, own in zip(blocks, columns, strict=True)],
        shared_offset=shared,
    )
    arms, unsure = np.zeros(len(spreads)), np.diag(spreads**2)
    if found.condition_number <= SINGULAR:
        own = slice(size, size + len(tried))
        drawn = _drawn(found.values[own], found.covariance[own, own], spreads[tried])
        arms[tried], unsure[np.ix_(tried, tried)] = drawn
    follows = np.column_stack(
        [
            effect_of(blocks, [own[:, place] for own in columns], shared_offset=shared)
            for place in range(len(spreads))
        ]
    )
    moved = -follows @ arms
    covariance = fit.covariance.copy()
    covariance[:size, :size] += follows @ unsure @ follows.T
    offsets = {
        block.label: fit.offsets[block.label]
        - float(np.mean(block.regressor, axis=0) @ moved)
        - float(np.mean(own, axis=0) @ arms)
        for block, own in zip(blocks, columns, strict=True)
    }
    return replace(
        fit,
        values=fit.values + moved,
        covariance=covariance,
        offsets=fit.offsets if shared else {**fit.offsets, **offsets},
        moment_arms=(float(arms[0]), float(arms[1])),
        turned=float(arms[2]),
        imu_turned=(float(arms[3]), float(arms[4]), float(arms[5])),
        notes=(*fit.notes, *_said(fit, arms, np.sqrt(np.diag(unsure)), spread)),
    )


def _seen(blocks: Sequence[Block], columns: Sequence[Array], spreads: Array) -> Mask:
    """Which columns, by one deviation each, add anything to the torque that no offset takes up, (k,)."""
    moved = [own - own.mean(axis=0) for own in columns]
    torque = np.concatenate([block.response - block.response.mean() for block in blocks])
    added = spreads * np.sqrt(np.mean(np.concatenate(moved) ** 2, axis=0))
    return np.asarray(added > UNSEEN * np.sqrt(np.mean(torque**2)))


def _beside(block: Block, columns: Array) -> Block:
    noise = None if block.noise is None else np.append(block.noise, np.zeros(columns.shape[1]))
    return replace(block, regressor=np.column_stack([block.regressor, columns]), noise=noise)


def _drawn(found: Array, covariance: Array, spreads: Array) -> tuple[Array, Array]:
    """Coefficients (k,) drawn to zero by their prior, and their covariance (k, k)."""
    prior = np.diag(spreads**2)
    keeps = prior @ np.linalg.pinv(prior + covariance)
    return keeps @ found, keeps @ covariance


def _said(fit: AxisFit, place: Array, std: Array, spread: PlaceSpread) -> list[Note]:
    """A warning where the centre is clearly elsewhere, or a sensor turned."""
    limits = np.maximum(
        CLEAR * np.hypot(spread.deviations, std), [WORTH_SAYING] * 2 + [TURN_WORTH_SAYING] * 4
    )
    aside, above, turned, *imu = np.abs(place) > limits
    (x, z, yaw), (of_x, of_z, of_yaw) = 1e3 * place[:3], 1.96e3 * std[:3]
    told, key = [], f"feet.{fit.foot}"
    if aside:
        where = "forward or backward" if fit.axis == "pitch" else "to the side"
        told.append(f"about a point {abs(x):.0f} ± {of_x:.0f} mm {where} of {key}.bush and {key}.wrench")
    if above:
        told.append(
            f"about a point {abs(z):.0f} ± {of_z:.0f} mm {'above' if z > 0 else 'below'} {key}.bush and {key}.wrench"
        )
    if turned:
        degrees = np.degrees([1e-3 * abs(yaw), 1e-3 * of_yaw])
        told.append(
            f"about an axis {degrees[0]:.1f} ± {degrees[1]:.1f} deg beside {key}.wrench.rpy or imu.rpy"
        )
    for name, clear, angle, of in zip("xyz", imu, place[3:], std[3:], strict=True):
        if clear:
            told.append(
                f"as if the IMU were turned by {np.degrees(abs(angle)):.1f} ± {np.degrees(1.96 * of):.1f} deg "
                f"about its {name} axis, beside imu.rpy"
            )
    if not told:
        return []
    text = f"{fit.foot} {fit.axis}: the torques turn {'; '.join(told)} (95 %): corrected"
    if (np.abs(place) > FARTHEST).any():
        return [Note(FAR, "warning", f"{text}, but that is far for an oversight; check the robot file")]
    return [Note("bush_place", "warning", f"{text}; check the robot file")]

"""Where the bush's centre is, beside the robot file's place: standing motions show it, as steps do.

A centre that is aside makes a torque that grows with the load, one that is higher a torque that grows with the
horizontal force; where the force sensor or the IMU is turned about the vertical, the other axis' torque shows. All are
columns beside the model's, with the robot file's uncertainty as a prior: logs that show the place sharply outweigh it,
logs that do not leave it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import Array
from plantar.estimation import effect_of, fit_blocks
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.regression_data import beside, place_columns, tangent_blocks, turn_column
from plantar.feet.recording import Recording
from plantar.notes import Note
from plantar.robot.model import RobotModel

GUESSED = 0.02  # m: what a guess without a spread of its own may be off by
CLEAR = 3.0  # deviations of prior and data together, beyond which the robot file's place is called wrong
FARTHEST = np.array([0.05, 0.05, 0.12])  # m, m, rad: what is still corrected without doubting all the rest
FAR = "bush_place_far"
WORTH_SAYING = 0.005  # m: a centre that is nearer to its place is within what drawings get wrong
TURN_WORTH_SAYING = 0.02  # rad: of a mount, likewise
SINGULAR = 1e6  # condition of the fit beyond which the motions do not show the place


@dataclass(frozen=True)
class PlaceSpread:
    """Deviation of the centre's place, `aside` and `above` [m], and of how far a sensor is `turned` in yaw [rad]."""

    aside: float
    above: float
    turned: float

    @classmethod
    def of(cls, robot: RobotModel, foot: str) -> PlaceSpread:
        """From the robot file: its uncertainty, and what its guesses of bush and force sensor may be off by."""
        if robot.feet[foot].contact == "always":  # its sensor was zeroed under load: the load is not known
            return cls(0.0, 0.0, 0.0)
        position = robot.uncertainty.bush_position
        for guess in robot.guesses:
            if guess.key.startswith((f"feet.{foot}.bush", f"feet.{foot}.wrench")):
                position = max(position, GUESSED if guess.spread is None else guess.spread)
        # Of a force sensor, a force that shows in a torque is like an arm: of the load aside, of the others above.
        arm = float(np.hypot(position, robot.uncertainty.wrench_crosstalk)) if position else 0.0
        return cls(arm, arm, robot.uncertainty.imu_mount)


def about_its_place(
    fit: AxisFit, recordings: Sequence[Recording], spread: PlaceSpread, shared: bool
) -> AxisFit:
    """The fit of a standing foot about where its centre is, widened by what that leaves unknown.

    What the fit has found of the place before is drawn to the robot file anew. A foot that steps has its centre from
    its stances already.
    """
    blocks = tangent_blocks(recordings, fit, drift=not shared)
    spreads = np.array([spread.aside, spread.above, spread.turned, spread.turned])
    if blocks[0].stances is not None or not spreads.any():
        return fit
    by_name = {one.name: one for one in recordings}
    columns = [_columns(by_name[block.label], fit) for block in blocks]
    count = columns[0].shape[1]
    size, spreads = blocks[0].regressor.shape[1], spreads[:count]
    before = np.array([*fit.moment_arms, fit.turned, fit.imu_turned])[:count]
    found = fit_blocks(
        [beside(block, own) for block, own in zip(blocks, columns, strict=True)], shared_offset=shared
    )
    if found.condition_number > SINGULAR:
        arms, unsure = np.zeros(count), np.diag(spreads**2)
    else:
        arms, unsure = _drawn(
            before + found.values[size:], found.covariance[size : size + count, size : size + count], spreads
        )
    follows = np.column_stack(
        [
            effect_of(blocks, [own[:, place] for own in columns], shared_offset=shared)
            for place in range(count)
        ]
    )
    moved = -follows @ (arms - before)
    covariance = fit.covariance.copy()
    covariance[:size, :size] += follows @ unsure @ follows.T
    offsets = {
        block.label: fit.offsets[block.label]
        - float(np.mean(block.regressor, axis=0) @ moved)
        - float(np.mean(own, axis=0) @ (arms - before))
        for block, own in zip(blocks, columns, strict=True)
    }
    return replace(
        fit,
        values=fit.values + moved[: len(fit.values)],
        shape=fit.shape + moved[len(fit.values) :] if size == len(fit.numbers) else fit.shape,
        covariance=covariance,
        offsets=fit.offsets if shared else {**fit.offsets, **offsets},
        moment_arms=(float(arms[0]), float(arms[1])),
        turned=float(arms[2]),
        imu_turned=float(arms[3]) if count > 3 else 0.0,
        notes=(*fit.notes, *_said(fit, arms[:3], np.sqrt(np.diag(unsure))[:3], spread)),
    )


def _columns(recording: Recording, fit: AxisFit) -> Array:
    """Columns at the used samples, (n, 3); beside a memory (n, 4): there a turned IMU is unlike a turned sensor."""
    columns = place_columns(recording, fit.foot, fit.axis)
    if fit.model.remembers:
        columns = np.column_stack([columns, turn_column(recording, fit)])
    return np.asarray(columns[recording.used(fit.foot)])


def _drawn(found: Array, covariance: Array, spreads: Array) -> tuple[Array, Array]:
    """Coefficients (m,) drawn to zero by their prior, and their covariance (m, m)."""
    prior = np.diag(spreads**2)
    keeps = prior @ np.linalg.pinv(prior + covariance)
    return keeps @ found, keeps @ covariance


def _said(fit: AxisFit, place: Array, std: Array, spread: PlaceSpread) -> list[Note]:
    """A warning where the centre is clearly elsewhere, or a sensor turned."""
    limits = np.maximum(
        CLEAR * np.hypot([spread.aside, spread.above, spread.turned], std),
        [WORTH_SAYING, WORTH_SAYING, TURN_WORTH_SAYING],
    )
    aside, above, turned = np.abs(place) > limits
    (x, z, yaw), (of_x, of_z, of_yaw) = 1e3 * place, 1.96e3 * std
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
    if not told:
        return []
    text = f"{fit.foot} {fit.axis}: the torques turn {'; '.join(told)} (95 %): corrected"
    if (np.abs(place) > FARTHEST).any():
        return [Note(FAR, "warning", f"{text}, but that is far for an oversight; check the robot file")]
    return [Note("bush_place", "warning", f"{text}; check the robot file")]

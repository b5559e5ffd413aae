"""Where the bush's centre is, beside the robot file's place: standing motions show it, as steps do.

A centre that is aside makes a torque that grows with the load, one that is higher a torque that grows with the
horizontal force. Where the force sensor is turned about the vertical, the other axis' torque shows. Where the IMU is
turned in its mount, the angles are off by what the joints between it and the foot make of that. All are columns beside
the model's, with the robot file's uncertainty as a prior: logs that show the place sharply outweigh it, logs that do
not leave it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, UNIFORM, Array, Axis, Mask
from plantar.estimation import Block, LinearFit, effect_of, fit_blocks, influences_of
from plantar.estimation.errors_in_variables import attenuation
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.load_torque import ENCODERS_APART, late_encoder_torque, others_torque, place_columns
from plantar.feet.fit.place_notes import (
    BUSH_WORTH_SAYING,
    CLEAR,
    FAR,
    PLACE,
    STEPS_WORTH_SAYING,
    place_notes,
    turned_bush,
)
from plantar.feet.fit.regression_data import beside, model_columns, tangent_blocks
from plantar.feet.recording import Recording
from plantar.notes import Note
from plantar.robot.model import RobotModel

GUESSED = 0.02  # m: what a guess without a spread of its own may be off by
TURN_STEP = 1e-3  # rad, of the differences that stand for derivatives
GUESSED_TURN = 0.02  # rad: of an IMU whose mount nobody measured, about any axis
ALIKE = 0.5  # of another foot's height above the robot file's place
UNSEEN = 1e-4  # of the torque's rms: what one deviation of a place adds beside it is as good as nothing
ENCODERS_LATE = UNIFORM * ENCODERS_APART  # s
SURE = 5.0  # deviations of the other axis' share, from which stances show it
STEPS_LEAVE = 0.75  # of the squares that the model of one axis leaves
SINGULAR = 1e6  # condition of the fit beyond which the motions do not show the place


@dataclass(frozen=True)
class PlaceSpread:
    """Deviation of the centre's place, `aside` and `above` [m], and of how far force sensor or IMU are `turned` [rad]
    about any axis. `height` [m]: how far above the robot file's place the other axis shows the centre; `between` [m]:
    by how much the axes' heights may seem to differ."""

    aside: float
    above: float
    turned: float
    height: float = 0.0
    between: float = np.inf

    @property
    def deviations(self) -> Array:
        """Of the centre's place, the force sensor's yaw, and the IMU's turn about three axes, (6,)."""
        return np.array([self.aside, self.above, *[self.turned] * 4])

    @property
    def expected(self) -> Array:
        """The deviations, that of the height from what the other axis shows where it does, (6,)."""
        known = min(self.above, self.between) if self.height else self.above
        return np.array([self.aside, known, *[self.turned] * 4])

    def known_from(self, fits: Mapping[Axis, AxisFit], axis: Axis) -> PlaceSpread | None:
        """Expecting the height that the other axis shows, where that is far off, and farther than this axis shows it.

        Bush and force sensor have one height: a robot file that is wrong about it is so for both axes, and draws the
        one more to itself whose motions show less. What is guessed is guessed of both axes at once: they differ less.
        """
        (height,) = (fit.moment_arms[1] for other, fit in fits.items() if other != axis)
        above = min(self.above, self.between)
        far = abs(height) > max(CLEAR * above, abs(fits[axis].moment_arms[1]))
        return replace(self, height=height) if far else None

    def doubted_by(self, others: Sequence[AxisFit], own: Sequence[AxisFit]) -> PlaceSpread:
        """Wide enough for the height that motions show at another foot: who is wrong about one foot is about both.

        As it is where no other foot shows it far off, or this one's own motions show as much.
        """
        told = [fit for fit in others if any(note.code in (PLACE, FAR) for note in fit.notes)]
        height = max((abs(fit.moment_arms[1]) for fit in told), default=0.0)
        least = min((abs(fit.moment_arms[1]) for fit in own), default=height)
        doubted = height > CLEAR * self.above and least < ALIKE * height
        return replace(self, above=height) if doubted else self

    @classmethod
    def of(cls, robot: RobotModel, foot: str) -> PlaceSpread:
        """From the robot file: its uncertainty, and what its guesses of bush and force sensor may be off by."""
        if robot.feet[foot].contact == "always":  # its sensor was zeroed under load: the load is not known
            return cls(0.0, 0.0, 0.0)
        position, turned = robot.uncertainty.bush_position, robot.uncertainty.imu_mount
        for guess in robot.guesses:
            if guess.key == "imu" and turned:
                turned = max(turned, GUESSED_TURN)
            if guess.key.startswith((f"feet.{foot}.bush", f"feet.{foot}.wrench")):
                position = max(position, GUESSED if guess.spread is None else guess.spread)
        # Of a force sensor, a force that shows in a torque is like an arm: of the load aside, of the others above.
        crosstalk = robot.uncertainty.wrench_crosstalk
        arm = float(np.hypot(position, crosstalk)) if position else 0.0
        measured = float(np.hypot(robot.uncertainty.bush_position, crosstalk))
        return cls(arm, arm, turned, between=measured or np.inf)


def about_its_place(
    fit: AxisFit, recordings: Sequence[Recording], spread: PlaceSpread, shared: bool
) -> AxisFit:
    """The fit of a standing foot about where its centre is, widened by what that leaves unknown; its offsets are as
    before (`corrections.with_best_offsets`).

    What the fit has found of the place before is drawn to the robot file anew. A foot that steps has its centre from
    its stances already.
    """
    blocks = tangent_blocks(recordings, fit, drift=not shared)
    if blocks[0].stances is not None or not spread.deviations.any():
        return fit
    chosen = [one for one in recordings if one.name in {block.label for block in blocks}]
    columns = [_columns(one, fit)[one.rows(fit.foot)] for one in chosen]
    spreads = np.where(that_show(blocks, columns, spread.expected), spread.expected, 0.0)
    size, tried = blocks[0].regressor.shape[1], np.flatnonzero(spreads)
    before = np.array([*fit.moment_arms, fit.turned, *fit.imu_turned])
    late = [late_encoder_torque(one, fit)[one.rows(fit.foot), None] for one in chosen]
    plain = [beside(block, own[:, tried]) for block, own in zip(blocks, columns, strict=True)]
    found, noisy, apart = _with_late_encoders(plain, late, shared)
    place, unsure = np.zeros(len(spreads)), np.diag(spreads**2)
    place[1] = spread.height
    if noisy is not None:
        own, priors = slice(size, size + len(tried) + len(apart)), np.append(spreads[tried], apart)
        doubt = UNIFORM * noisy[own]
        seen = np.append(before[tried] - place[tried], 0.0 * apart) + (found.values + noisy)[own]
        drawn, left = _drawn(seen, found.covariance[own, own] + np.outer(doubt, doubt), priors)
        place[tried] += drawn[: len(tried)]
        unsure[np.ix_(tried, tried)] = left[: len(tried), : len(tried)]
    follows = effect_of(influences_of(blocks, shared_offset=shared), columns)
    moved = -follows @ (place - before)
    covariance = fit.covariance.copy()
    covariance[:size, :size] += follows @ unsure @ follows.T
    # An offset is the torque at zero angle: it moves with the IMU's turn, also with one that does not show.
    unshown = np.diag(np.where(spreads > 0, 0.0, spread.deviations) ** 2)
    offset_std = dict(fit.offset_std)
    for block, column in zip(blocks, columns, strict=True):
        slope = np.mean(block.regressor, axis=0) @ follows - np.mean(column, axis=0)
        offset_std[block.label] = float(
            np.sqrt(fit.offset_std[block.label] ** 2 + slope @ (unsure + unshown) @ slope)
        )
    return replace(
        fit,
        values=fit.values + moved[: len(fit.values)],
        shape=shape_moved(fit.shape, moved[len(fit.values) :]) if size == len(fit.numbers) else fit.shape,
        covariance=covariance,
        offset_std=offset_std,
        moment_arms=(float(place[0]), float(place[1])),
        turned=float(place[2]),
        imu_turned=(float(place[3]), float(place[4]), float(place[5])),
        notes=(*fit.notes, *place_notes(fit, place, np.sqrt(np.diag(unsure)), spread.deviations)),
    )


def _with_late_encoders(
    blocks: Sequence[Block], late: Sequence[Array], shared: bool
) -> tuple[LinearFit, Array | None, Array]:
    """The fit of blocks beside encoders that may be read apart from the IMU, what noise takes off its values (None
    where motions do not show them), and by how much encoders may be apart [s], (0 or 1,).

    Their torque goes with the joints' motion, as horizontal forces do. Where joints alone bend the bush it is damping:
    then it is left out.
    """
    wider = [beside(block, own) for block, own in zip(blocks, late, strict=True)]
    for tried, apart in ((wider, [ENCODERS_LATE]), (blocks, [])):
        found = fit_blocks(tried, shared_offset=shared)
        # A push bends the foot and turns about the place alike: what noise takes off the one, the other takes up.
        noisy = attenuation(_with_noise(tried, found), found.values, shared_offset=shared)
        if found.condition_number <= SINGULAR and noisy is not None:
            return found, noisy, np.array(apart)
    return found, None, np.zeros(0)


def _with_noise(blocks: Sequence[Block], fit: LinearFit) -> list[Block]:
    """The blocks with half of what their fit leaves as noise of the angle: somewhere from none to all of it is.

    An attitude that wanders is more of it than the white noise which the blocks know of.
    """
    spring = abs(float(fit.values[0])) or 1.0
    noisy = []
    for block in blocks:
        noise = np.zeros(block.regressor.shape[1]) if block.noise is None else block.noise.copy()
        noise[0] += 0.5 * float(np.mean(fit.residuals[block.label] ** 2)) / spring**2
        noisy.append(replace(block, noise=noise))
    return noisy


def turned_bush_note(
    fits: Mapping[Axis, AxisFit], recordings: Sequence[Recording], shared: bool
) -> Note | None:
    """`turned_bush` of one foot's fits, of which both axes must be there."""
    if not set(ROTATIONAL_AXES) <= set(fits):
        return None
    pitch, roll = (fits[axis] for axis in ROTATIONAL_AXES)
    in_pitch, in_roll = (_others_torque(fit, recordings, shared) for fit in (pitch, roll))
    if in_pitch is None or in_roll is None:
        return turned_bush(pitch.foot, pitch.turned, roll.turned, BUSH_WORTH_SAYING)
    (of_roll, left), (of_pitch, also_left) = in_pitch, in_roll
    # A leg that gives way shows some of it as well, but explains little of what the feet's models leave.
    explained = min(left, also_left) < STEPS_LEAVE and of_roll != 0 and of_pitch != 0
    return turned_bush(pitch.foot, of_roll, of_pitch, STEPS_WORTH_SAYING) if explained else None


def _others_torque(fit: AxisFit, recordings: Sequence[Recording], shared: bool) -> tuple[float, float] | None:
    """The share of the other axis' torque that shows in this one, 0 where unsure; None of a foot that stands.

    With it the share that it leaves of what the model leaves, in squares.
    """
    blocks = tangent_blocks(recordings, fit, drift=not shared)
    if blocks[0].stances is None:
        return None
    blocks = [_without_the_other(block) for block in blocks]
    by_name = {recording.name: recording for recording in recordings}
    chosen = [by_name[block.label] for block in blocks]
    other = [others_torque(one, fit.foot, fit.axis)[one.rows(fit.foot), None] for one in chosen]
    wider = [beside(block, own) for block, own in zip(blocks, other, strict=True)]
    fits = [fit_blocks(each, shared_offset=shared) for each in (blocks, wider)]
    before, left = (
        sum(float(residual @ residual) for residual in found.residuals.values()) for found in fits
    )
    size, found = blocks[0].regressor.shape[1], fits[1]
    sure = found.condition_number <= SINGULAR and abs(found.values[size]) > SURE * found.std[size]
    return (float(found.values[size]) if sure else 0.0), left / max(before, np.finfo(float).tiny)


def _without_the_other(block: Block) -> Block:
    """The block of a foot that steps without the other axis' torque among its nuisances, their third column."""
    assert block.common_nuisance is not None, "a block of a foot that steps"
    assert block.common_spread is not None, "a block of a foot that steps"
    kept = [0, 1, 3]
    return replace(
        block, common_nuisance=block.common_nuisance[:, kept], common_spread=block.common_spread[kept]
    )


def shape_moved(shape: Array, by: Array) -> Array:
    """Nonlinear parameters (s,) after a linear step `by` (s,), taken in their logarithm, at most by a factor of e.

    They are positive and found by their logarithm; a straight step from bad data would take them below zero.
    """
    return np.asarray(shape * np.exp(np.clip(by / shape, -1.0, 1.0)))


def _columns(recording: Recording, fit: AxisFit) -> Array:
    """Torque (N, 6) for each metre or radian by which the centre, the force sensor and the IMU are elsewhere."""

    return np.column_stack([place_columns(recording, fit.foot, fit.axis), imu_columns(recording, fit)])


def imu_columns(recording: Recording, fit: AxisFit) -> Array:
    """Torque (N, 3) for each radian by which the IMU is turned about its axes, under a fit's model."""

    def turned(angle: float, axis: Array) -> Array:
        x, y, z = np.array(fit.imu_turned) + angle * axis
        return model_columns(recording, fit.foot, fit.axis, replace(fit, imu_turned=(x, y, z))) @ fit.values

    turns = [(turned(TURN_STEP, axis) - turned(-TURN_STEP, axis)) / (2 * TURN_STEP) for axis in np.eye(3)]
    return np.column_stack(turns)


def that_show(blocks: Sequence[Block], columns: Sequence[Array], spreads: Array) -> Mask:
    """Which columns, by one deviation each, add anything to the torque that no offset takes up, (k,)."""
    moved = [own - own.mean(axis=0) for own in columns]
    torque = np.concatenate([block.response - block.response.mean() for block in blocks])
    added = spreads * np.sqrt(np.mean(np.concatenate(moved) ** 2, axis=0))
    return np.asarray(added > UNSEEN * np.sqrt(np.mean(torque**2)))


def _drawn(found: Array, covariance: Array, spreads: Array) -> tuple[Array, Array]:
    """Coefficients (k,) drawn to zero by their prior, and their covariance (k, k)."""
    prior = np.diag(spreads**2)
    keeps = prior @ np.linalg.pinv(prior + covariance)
    return keeps @ found, keeps @ covariance

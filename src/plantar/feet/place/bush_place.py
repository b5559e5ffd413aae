"""Where the bush's centre is, beside the robot file's place: standing motions show it, as steps do.

A centre that is aside makes a torque that grows with the load, one that is higher a torque that grows with the
horizontal force. Where the force sensor is turned about the vertical, the other axis' torque shows. Where the IMU is
turned in its mount, the angles are off by what the joints between it and the foot make of that. All are columns beside
the model's, with the robot file's uncertainty as a prior: logs that show the place sharply outweigh it, logs that do
not leave it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import UNIFORM, Array
from plantar.estimation import Block, LinearFit
from plantar.estimation.errors_in_variables import attenuation
from plantar.estimation.orthonormal import without
from plantar.feet.place.imu_mount import imu_columns, that_show
from plantar.feet.place.place_notes import place_notes
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.load_torque import ENCODERS_APART, late_encoder_torque, place_columns
from plantar.feet.regression.tangent import Tangent
from plantar.model_selection.absorbed_noise import lacking
from plantar.model_selection.partialled_out import Linearised

ENCODERS_LATE = UNIFORM * ENCODERS_APART  # s


def about_its_place(
    fit: AxisFit, recordings: Sequence[Recording], spread: PlaceSpread, shared: bool
) -> AxisFit:
    """The fit of a standing foot about where its centre is, widened by what that leaves unknown; its offsets are as
    before (`corrections.with_best_offsets`).

    What the fit has found of the place before is drawn to the robot file anew. A foot that steps has its centre from
    its stances already.
    """
    tangent = Tangent.of(fit, recordings, shared)
    blocks = tangent.blocks
    if tangent.steps or not spread.deviations.any():
        return fit
    columns = tangent.rows(lambda one: centre_columns(one, fit))
    spreads = np.where(that_show(blocks, columns, spread.expected), spread.expected, 0.0)
    size, tried = blocks[0].regressor.shape[1], np.flatnonzero(spreads)
    before = np.array([*fit.moment_arms, fit.turned, *fit.imu_turned])
    late = tangent.rows(lambda one: late_encoder_torque(one, fit)[:, None])
    found, noisy, apart = _with_late_encoders(tangent.beside([own[:, tried] for own in columns]), late)
    place, unsure = np.zeros(len(spreads)), np.diag(spreads**2)
    place[1] = spread.height
    if noisy is not None:
        own, priors = slice(size, size + len(tried) + len(apart)), np.append(spreads[tried], apart)
        doubt = UNIFORM * noisy[own]
        seen = np.append(before[tried] - place[tried], 0.0 * apart) + (found.values + noisy)[own]
        drawn, left = _drawn(seen, found.covariance[own, own] + np.outer(doubt, doubt), priors)
        place[tried] += drawn[: len(tried)]
        unsure[np.ix_(tried, tried)] = left[: len(tried), : len(tried)]
    follows = tangent.effect(columns)
    moved = -follows @ (place - before)
    covariance, variance = fit.covariance.copy(), {}
    covariance[:size, :size] += follows @ unsure @ follows.T
    for cause, own in (("bush position", slice(0, 3)), ("imu turn", slice(3, 6))):
        variance[cause] = np.zeros(len(covariance))
        variance[cause][:size] = np.diag(follows[:, own] @ unsure[own, own] @ follows[:, own].T)
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
        place_std=tuple(np.sqrt(np.diag(unsure) + np.diag(unshown)).tolist()),
        place_variance=variance,
        notes=(*fit.notes, *place_notes(fit, place, np.sqrt(np.diag(unsure)), spread.deviations)),
    )


def _with_late_encoders(tangent: Tangent, late: Sequence[Array]) -> tuple[LinearFit, Array | None, Array]:
    """The fit of a tangent beside encoders that may be read apart from the IMU, what noise takes off its values (None
    where motions do not show them), and by how much encoders may be apart [s], (0 or 1,).

    Their torque goes with the joints' motion, as horizontal forces do. Where joints alone bend the bush it is damping:
    then it is left out.
    """
    for tried, apart in ((tangent.beside(late), [ENCODERS_LATE]), (tangent, [])):
        found = tried.least_squares
        # A push bends the foot and turns about the place alike: what noise takes off the one, the other takes up.
        noisy = attenuation(_with_noise(tried), found.values, shared_offset=tried.shared)
        if not found.singular and noisy is not None:
            return _with_absorbed_noise(tried), noisy, np.array(apart)
    return found, None, np.zeros(0)


def _with_absorbed_noise(tangent: Tangent) -> LinearFit:
    """The fit of a tangent, as unsure as an attitude that wanders makes it: beside so many columns it takes up some."""
    blocks, found = tangent.blocks, tangent.least_squares
    drifts = [np.zeros((len(one.response), 0)) if one.nuisance is None else one.nuisance for one in blocks]
    rows = [
        without(drift, np.column_stack([one.regressor, one.response]))
        for one, drift in zip(blocks, drifts, strict=True)
    ]
    table = np.vstack(rows)
    linear = Linearised(table[:, :-1], table[:, -1], [len(own) for own in rows], tangent.shared)
    wide = np.ones(len(found.covariance))
    wide[: linear.size] = lacking(linear, drifts, [one.duration for one in blocks])
    return replace(found, covariance=found.covariance * np.outer(wide, wide))


def _with_noise(tangent: Tangent) -> list[Block]:
    """The blocks with half of what their fit leaves as noise of the angle: somewhere from none to all of it is.

    An attitude that wanders is more of it than the white noise which the blocks know of.
    """
    fit = tangent.least_squares
    spring = abs(float(fit.values[0])) or 1.0
    noisy = []
    for block in tangent.blocks:
        noise = np.zeros(block.regressor.shape[1]) if block.noise is None else block.noise.copy()
        noise[0] += 0.5 * float(np.mean(fit.residuals[block.label] ** 2)) / spring**2
        noisy.append(replace(block, noise=noise))
    return noisy


def shape_moved(shape: Array, by: Array) -> Array:
    """Nonlinear parameters (s,) after a linear step `by` (s,), taken in their logarithm, at most by a factor of e.

    They are positive and found by their logarithm; a straight step from bad data would take them below zero.
    """
    return np.asarray(shape * np.exp(np.clip(by / shape, -1.0, 1.0)))


def centre_columns(recording: Recording, fit: AxisFit) -> Array:
    """Torque (N, 6) for each metre or radian by which the centre, the force sensor and the IMU are elsewhere."""

    return np.column_stack([place_columns(recording, fit.foot, fit.axis), imu_columns(recording, fit)])


def _drawn(found: Array, covariance: Array, spreads: Array) -> tuple[Array, Array]:
    """Coefficients (k,) drawn to zero by their prior, and their covariance (k, k)."""
    prior = np.diag(spreads**2)
    keeps = prior @ np.linalg.pinv(prior + covariance)
    return keeps @ found, keeps @ covariance

"""A zero of the yaw torque passes for a stiffness of its own in recordings that move roll little, and is none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from feet_trials import PUNCTUAL
from made_recording import FOOT, made_recording, swayed
from plantar.estimation import fit_blocks
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.interval_width.between_recordings import axis_differences, recordings_apart
from plantar.feet.interval_width.yaw_zero import fit_beside, yaw_torque_zero, yaw_zeros
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import all_beside
from plantar.feet.regression.tangent import Tangent

STIFFNESS = 400.0


def rolled(zero: float, apart: float = 0.0, offset: float = 0.7) -> tuple[list[Recording], AxisFit]:
    """Roll in one recording, pitch and a tenth of its roll in the other, whose yaw torque reads `zero` [N·m] too much
    and whose rubber is stiffer by the share `apart`."""
    random, recordings = np.random.default_rng(3), []
    for place, size in enumerate((1.0, 0.1)):
        pitch, roll = swayed(seed=10 + place), size * swayed(seed=place)
        torque = STIFFNESS * (1 + apart * place) * roll - zero * place * np.sin(pitch)
        one = made_recording(f"sway_{place}", roll, torque + random.normal(0, 0.02, len(roll)))
        state = replace(one.bushes[FOOT], deflection=np.column_stack([pitch + roll, roll]))
        recordings.append(replace(one, raw={FOOT: state}, bushes={FOOT: state}))
    fit = fit_axis(recordings, FOOT, "roll", replace(PUNCTUAL, model="kelvin_voigt"))
    assert fit is not None
    return recordings, replace(fit, offsets={"sway_0": offset, "sway_1": -offset})


def differences(recordings: list[Recording], fit: AxisFit) -> float:
    found = axis_differences(Tangent.of(fit, recordings, False))
    assert found is not None
    return recordings_apart([found], 0.0, exact=False).share


def test_a_zero_is_not_a_recording_that_differs() -> None:
    """Pitch and roll move together in the second recording: its roll torque reads 1 N·m times the sine of both."""
    assert differences(*rolled(0.0)) < 0.002
    assert differences(*rolled(1.0)) < 0.003
    recordings, fit = rolled(1.0)
    assert differences(recordings, replace(fit, offsets={"sway_0": 0.0, "sway_1": 0.0})) > 0.005, (
        "where zeros are none it is the rubber"
    )


@pytest.mark.parametrize("zero", [0.0, 1.0])
def test_rubber_that_differs_is_still_seen(zero: float) -> None:
    assert differences(*rolled(zero, apart=0.03)) > 0.3 * 0.03


def test_zeros_are_as_free_as_is_usual() -> None:
    """Between a fit that has none, and one that knows nothing of them: the mean and covariance of a Gaussian prior."""
    recordings, fit = rolled(1.0)
    tangent = Tangent.of(fit, recordings, False)
    blocks, zeros = tangent.blocks, yaw_zeros(tangent)
    assert zeros is not None
    assert zeros.usual == pytest.approx(0.7)
    assert yaw_zeros(replace(tangent, fit=replace(fit, axis="pitch"))) is None
    without, free = (fit_beside(each, blocks) for each in (None, zeros._replace(usual=1e6)))
    np.testing.assert_array_equal(without[0], fit_blocks(blocks).values)
    assert free[0][0] == pytest.approx(STIFFNESS, rel=1e-3)
    held = fit_beside(zeros, blocks)
    assert 0 < held[1][0, 0] <= free[1][0, 0]
    # Information adds up, and each value counts by its own.
    size, found = len(without[0]), fit_blocks(all_beside(blocks, zeros.columns))
    known = np.linalg.inv(found.covariance[: size + 2, : size + 2])
    usual = 2 * float(found.std[size])
    prior = np.diag([*np.zeros(size), *np.full(2, usual**-2)])
    both = np.linalg.inv(known + prior)
    held = fit_beside(zeros._replace(usual=usual), blocks)
    np.testing.assert_allclose(held[1], both[:size, :size], rtol=1e-6)
    np.testing.assert_allclose(held[0], (both @ known @ found.values[: size + 2])[:size], rtol=1e-6)


def test_zeros_that_no_motion_shows_are_as_large_as_is_usual_and_move_no_value() -> None:
    """A pitch that stays as it is: its zero cannot be told from the offset."""
    recordings, fit = rolled(1.0)
    tangent = Tangent.of(fit, recordings, False)
    blocks, zeros = tangent.blocks, yaw_zeros(tangent)
    assert zeros is not None
    level = zeros._replace(columns=[0.1 * (each != 0) for each in zeros.columns])
    plain = fit_blocks(blocks)
    for found, right in zip(fit_beside(level, blocks), (plain.values, plain.covariance), strict=True):
        np.testing.assert_allclose(found, right[:2] if right.ndim == 1 else right[:2, :2], rtol=1e-12)
    tangent.influences[:] = [np.ones((2, len(block.response))) for block in blocks]
    cause = yaw_torque_zero(level, tangent)
    effect = [0.7 * np.sum(each, axis=0) for each in level.columns]
    np.testing.assert_allclose(cause.effect, np.linalg.norm(np.sum(effect, axis=0)), rtol=1e-9)

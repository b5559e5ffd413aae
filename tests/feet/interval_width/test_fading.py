"""Force sensors behind a slow low-pass widen spring and damper by what it moves them; none widens nothing."""

from __future__ import annotations

import numpy as np
import pytest

from feet_trials import LINEAR
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.conventions import UNIFORM
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.interval_width.sensor_causes import LOW_PASS, fading_causes
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.tangent import Tangent
from plantar.sensors.bandwidth import Fading

STIFFNESS, DAMPING = 400.0, 6.0
SLOPE = -0.01  # s²: behind a low-pass at 7 Hz
COUNT = 6000  # whole periods of both sines, so that a filter leaves no ends


def behind(slope: float) -> Recording:
    """A sway whose torques are behind a filter without lag, whose gain has the logarithm `slope` f²."""
    angle = swayed(COUNT)
    rate = np.gradient(angle, PERIOD)
    torque = np.fft.rfft(STIFFNESS * angle + DAMPING * rate)
    frequency = np.fft.rfftfreq(COUNT, PERIOD)
    return made_recording(
        "sway", angle, np.fft.irfft(np.exp(slope * frequency**2) * torque, COUNT), rate=rate
    )


def fitted(recording: Recording) -> AxisFit:
    fit = fit_axis([recording], FOOT, "pitch", LINEAR)
    assert fit is not None
    return fit


def test_a_unit_of_it_moves_the_numbers_as_a_low_pass_does() -> None:
    """Fitted through the filter and without it, on two sines of different frequencies: the difference is the effect."""
    recording = behind(SLOPE)
    fit, exact = fitted(recording), fitted(behind(0.0))
    (cause,) = fading_causes(Tangent.of(fit, [recording], False), Fading(SLOPE, 1e-4))
    moved = fit.values - exact.values
    assert moved[0] < -0.001 * STIFFNESS
    assert moved[1] < -0.002 * DAMPING
    np.testing.assert_allclose(-SLOPE * cause.effect, moved, rtol=0.02)
    assert (cause.name, cause.std) == (LOW_PASS, pytest.approx(UNIFORM * -SLOPE))


def test_without_a_slow_filter_nothing_is_widened() -> None:
    recording = behind(0.0)
    fit = fitted(recording)
    assert fading_causes(Tangent.of(fit, [recording], False), None) == []

"""What the twin knows of a foot, against what is computed from the log that its sensors would write."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.feet.prepare_log import prepare
from plantar.feet.recording import Recording
from plantar.twin.presets import preset_named
from plantar.twin.recording import TwinRecording, record
from plantar.twin.robots import hrp2
from plantar.twin.simulation.physics import Physics
from twin_samples import tilted


@pytest.fixture(scope="module")
def recording() -> TwinRecording:
    return record(tilted(), hrp2.robot(), Physics(), preset_named("ideal"), 0)


@pytest.mark.parametrize("foot", ["left", "right"])
def test_a_logs_feet_are_the_twins(recording: TwinRecording, foot: str) -> None:
    """Angles, rates, torques, loads and centres of pressure, of a robot that sways on both feet."""
    robot = hrp2.robot()
    found: Recording = prepare(robot, recording.log, "fit")
    state, truth = found.raw[foot], recording.truth.columns
    inner = slice(100, -100)

    def apart(measured: np.ndarray, name: str) -> float:
        true = np.interp(found.time, recording.truth.time, truth[f"{foot}.{name}"])[inner]
        return float(np.abs(measured[inner] - true).max() / max(np.ptp(true), 1e-9))

    for column, axis in enumerate(("pitch", "roll")):
        assert apart(state.deflection[:, column], f"deflection.{axis}") < 0.02
        assert apart(state.rate[:, column], f"rate.{axis}") < 0.05
        assert apart(state.torque[:, column], f"torque.{axis}") < 0.03
    for column, axis in enumerate("xy"):
        assert apart(state.cop[:, column], f"contact.cop.{axis}") < 0.05
    assert apart(state.force_z, "contact.force.z") < 0.02

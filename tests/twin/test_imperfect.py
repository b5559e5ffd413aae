"""The preset `imperfect`: each seed is a robot of its own, and the robot file stays what it was."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from plantar.robot.model import load_robot
from plantar.twin.play import play_all, write_campaign
from plantar.twin.presets import preset_named
from plantar.twin.recording import TwinRecording
from plantar.twin.robots import hrp2
from twin_samples import plan, short


@pytest.fixture(scope="module")
def played() -> dict[int, TwinRecording]:
    """One second of a tilt in three worlds, two of one seed."""
    motion = short(plan("Tilt3"), 4.0, 5.0)
    return {
        key: play_all([motion], preset="imperfect", seeds=[seed])[0][0] for key, seed in enumerate((1, 1, 2))
    }


def test_the_seed_decides(played: dict[int, TwinRecording]) -> None:
    first, again, other = played.values()
    for name, values in first.log.columns.items():
        np.testing.assert_array_equal(values, again.log.columns[name])
    assert first.truth.facts == again.truth.facts
    for key in ("robot", "sensor_errors", "bushes"):
        assert first.truth.facts[key] != other.truth.facts[key]


def test_the_truth_says_what_was_drawn_and_the_robot_file_stays(
    played: dict[int, TwinRecording], tmp_path: Path
) -> None:
    file = write_campaign(tmp_path, [played[0]], preset="imperfect")
    facts = json.loads((tmp_path / "Tilt3.truth.json").read_text())
    assert {"links", "imu", "left.bush", "right.wrench"} <= facts["robot"].keys()
    gains = np.array(facts["sensor_errors"]["wrench.left_foot.gains"])
    assert 0.001 < np.abs(np.diag(gains) - 1).max() < 0.05
    assert load_robot(file).urdf == load_robot(hrp2.write(tmp_path / "nominal")).urdf
    bush = facts["bushes"]["left"]["pitch_stiffness"] / 480 - 1
    assert bush == pytest.approx(preset_named("imperfect").stiffening(1, "Tilt3"), abs=1e-9)
    assert 1e-4 < abs(bush) < 0.05


def test_recordings_of_one_seed_share_the_robot_but_not_the_rubber() -> None:
    preset = preset_named("imperfect")
    shares = [preset.stiffening(seed, motion) for seed in range(200) for motion in ("Tilt3", "Squat")]
    assert np.std(shares) == pytest.approx(0.0068, rel=0.15)  # of 0.3 to 1 %
    assert preset.stiffening(4, "Tilt3") != preset.stiffening(4, "Squat")
    assert preset_named("realistic").stiffening(4, "Tilt3") == 0.0

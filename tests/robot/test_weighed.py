"""A robot that was weighed: its model weighs what the balance says, and nothing else of it changes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from biped_robot import make_robot
from plantar.errors import RobotError


def test_masses_and_moments_are_scaled_and_centres_stay(tmp_path: Path) -> None:
    plain, weighed = make_robot(tmp_path / "a"), make_robot(tmp_path / "b", mass=66.0)
    assert (weighed.mass, weighed.urdf_mass, plain.urdf_mass) == pytest.approx((66.0, 60.0, 60.0))
    for model, scaled in ((plain.model, weighed.model), (plain.floating_model, weighed.floating_model)):
        for own, other in zip(model.inertias, scaled.inertias, strict=True):
            np.testing.assert_allclose(
                other.toDynamicParameters(), 1.1 * own.toDynamicParameters(), atol=1e-12
            )


def test_only_a_weight_beyond_the_balances_doubt_is_told(tmp_path: Path) -> None:
    assert make_robot(tmp_path / "a").weight_notes == []
    assert make_robot(tmp_path / "b", mass=60.3, uncertainty={}).weight_notes == []
    (note,) = make_robot(tmp_path / "c", mass=62.0, uncertainty={}).weight_notes
    assert (note.code, note.severity) == ("weighed", "info")
    assert "62 kg" in note.text
    assert "60 kg" in note.text
    assert make_robot(tmp_path / "d", mass=62.0, uncertainty={"total_mass": 0.05}).weight_notes == []


@pytest.mark.parametrize("mass", [60000.0, 0.06, 132.0])
def test_another_unit_or_robot_is_refused(mass: float, tmp_path: Path) -> None:
    with pytest.raises(RobotError, match=r"mass: the URDF weighs 60 kg") as caught:
        make_robot(tmp_path, mass=mass)
    assert "kg" in str(caught.value).partition("valid")[2]


@pytest.mark.parametrize("mass", [0, -60, float("nan"), "sixty"])
def test_what_is_no_mass_is_refused(mass: object, tmp_path: Path) -> None:
    with pytest.raises(RobotError, match="mass"):
        make_robot(tmp_path, mass=mass)

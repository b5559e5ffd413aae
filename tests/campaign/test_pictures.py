"""Pictures of postures: the robot stands on the floor, the raised leg is raised."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.campaign.pictures import boxes, look_of
from plantar.twin.play import planned
from plantar.twin.robots import hrp2


def test_postures_stand_on_the_floor() -> None:
    robot = hrp2.robot()
    drawn = boxes(look_of(robot), planned("Manual_left_roll", robot))
    corners = np.vstack([box.corners for box in drawn])
    assert corners[:, 2].min() == pytest.approx(0.0, abs=1e-3)
    assert 1.4 < corners[:, 2].max() < 1.6
    feet = {
        box.side: box.corners[:, 2].min()
        for box in drawn
        if np.ptp(box.corners[:, 0]) == pytest.approx(0.2172, abs=0.01)
    }
    assert feet["right"] > 0.05 > feet["left"]  # the right leg is raised

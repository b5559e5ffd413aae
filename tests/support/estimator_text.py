"""The file of an estimator that is told nothing beside the robot."""

from __future__ import annotations

from plantar.online.estimator_model import estimator_model
from plantar.robot.model import RobotModel


def untold(robot: RobotModel) -> str:
    """No delay, no compliance, no memory: all is learnt."""
    return estimator_model(
        robot,
        cutoff=5.0,
        wrench_delay=(0.0, 0.0),
        elements={},
        compliance={},
        linear=(),
        misplaced={},
        bends={},
        unsure={},
    )

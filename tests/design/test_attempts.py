"""What becomes of a motion that legs do not reach, that touches itself, that falls: said, and made smaller."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest

from plantar.design.arms import arm_swing
from plantar.design.rehearsals import attempt
from plantar.design.rehearsals.rehearsal import Rehearsal
from plantar.errors import MotionError
from plantar.motions.body import Body
from plantar.twin.robots import hrp2

FACTORS = (0.5, 1.0, 2.0)
FREE = Rehearsal(1.0, (0.04, 0.04), (0.05, 0.05), least_load=1.0)
LEGS = SimpleNamespace(body=SimpleNamespace(robot=SimpleNamespace(name="biped")))


class Tried:
    """Until which try something is wrong, and what was said and done meanwhile."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, wrong: dict[str, int]) -> None:
        self.wrong, self.made, self.said, self.done = wrong, 0, list[str](), list[str]()
        trajectory = SimpleNamespace(of=self.of)
        monkeypatch.setattr(attempt, "Trajectory", trajectory)
        monkeypatch.setattr(attempt, "self_collision", self.collision)
        monkeypatch.setattr(attempt, "rehearse", self.rehearse)
        monkeypatch.setattr(attempt, "_with_results", lambda robot, found: found)

    def of(self, *_: Any) -> Any:
        self.made += 1
        if self.made <= self.wrong.get("reach", 0):
            raise MotionError("a leg is too short")
        return SimpleNamespace(configurations=None, knots=np.array([0.0, 1.25, 2.5]), plan=lambda: None)

    def collision(self, *_: Any) -> Any:
        touches = self.made <= self.wrong.get("touch", 0)
        return SimpleNamespace(touching=("arm", "hip", 1) if touches else None, pairs=7)

    def rehearse(
        self, robot: Any, plan: Any, told: Any, asked: list[float], progress: Any
    ) -> list[Rehearsal]:
        falls = "it falls" if self.made <= self.wrong.get("fall", 0) else None
        return [replace(FREE, factor=factor, fell=falls) for factor in asked]

    def run(self, arms: bool = True) -> Any:
        def note(name: str, answer: Any = None) -> Any:
            def do() -> Any:
                self.done.append(name)
                motion.rehearsals.clear()
                return answer

            return do

        reach = Mock(used_by_kind=lambda _: 0.87 * np.ones((3, 5)))
        motion = attempt.Attempt(reach, lambda _, start: start, np.arange(3.0), FACTORS)
        motion.shrink, motion.adapt = note("shrink"), note("adapt")  # type: ignore[method-assign]
        motion.lower_arms = note("lower arms", arms)  # type: ignore[method-assign]
        return attempt.until_it_holds(motion, LEGS, None, self.said.append)  # type: ignore[arg-type]


def test_a_motion_that_holds_is_rehearsed_at_every_stiffness(monkeypatch: pytest.MonkeyPatch) -> None:
    tried = Tried(monkeypatch, {})
    coefficients, _, rehearsals, pairs = tried.run()
    assert coefficients.tolist() == [0, 1, 2]
    assert [one.factor for one in rehearsals] == list(FACTORS)
    assert (pairs, tried.done, tried.said) == (7, [], ["identify the feet from the rehearsals"])


@pytest.mark.parametrize(
    ("wrong", "arms", "done", "said"),
    [
        ({"reach": 2}, True, ["shrink"] * 2, "smaller: a leg is too short"),
        ({"touch": 1}, True, ["lower arms"], "without arms: 'arm' touches 'hip' at 1.2 s"),
        ({"touch": 1}, False, ["lower arms", "shrink"], "smaller: 'arm' touches 'hip' at 1.2 s"),
        ({"fall": 1}, True, ["adapt"], "smaller: at 2 times the stiffness: it falls"),
    ],
)
def test_what_does_not_hold_is_said_and_made_smaller(
    wrong: dict[str, int], arms: bool, done: list[str], said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    tried = Tried(monkeypatch, wrong)
    tried.run(arms)
    assert (tried.done, tried.said[0]) == (done, said)
    assert len(tried.said) == 1 + max(wrong.values())


@pytest.mark.parametrize(
    ("what", "why"),
    [
        ("reach", "a leg is too short"),
        ("fall", "at 2 times the stiffness: it falls"),
        ("touch", "'arm' touches 'hip' at 1.2 s"),
    ],
)
def test_after_twelve_rounds_the_last_reason_is_told(
    what: str, why: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    Tried(monkeypatch, {what: 11}).run()
    with pytest.raises(MotionError, match=f"biped: no motion holds over the range of stiffness: {why}"):
        Tried(monkeypatch, {what: 12}).run()


def test_arms_swing_as_far_as_joints_let_them_each_in_the_sense_that_adds_up() -> None:
    """Joints whose speed turns the robot's angular momentum about y, by a fifth of the strongest at least."""
    robot = hrp2.robot()
    body = Body(robot)
    q, model = hrp2_standing(body), body.model
    swing = arm_swing(body, q)
    momenta = {}
    for name in model.names[2:]:
        joint = model.joints[model.getJointId(name)]
        speed = np.zeros(model.nv)
        speed[joint.idx_v] = 1.0
        momenta[name] = (angular_momentum(body, q, speed), joint, swing[joint.idx_v])
    moving = {name for name, (_, _, own) in momenta.items() if own}
    assert robot.imu is not None
    ends = (*(foot.ankle for foot in robot.feet.values()), robot.imu.placement.link)
    carriers = (model.frames[model.getFrameId(end)].parentJoint for end in ends)
    carrying = {model.names[one] for joint in carriers for one in model.supports[joint]}
    strongest = max(abs(momentum) for name, (momentum, _, _) in momenta.items() if name not in carrying)
    for name, (momentum, joint, own) in momenta.items():
        assert (name in moving) == (name not in carrying and abs(momentum) > 0.2 * strongest), name
        if own:
            place = q[joint.idx_q]
            room = min(
                model.upperPositionLimit[joint.idx_q] - place, place - model.lowerPositionLimit[joint.idx_q]
            )
            assert own == pytest.approx(np.sign(momentum) * min(0.3, 0.8 * room))


def hrp2_standing(body: Body) -> np.ndarray:
    import design_samples

    return np.array(design_samples.legs().start.configuration)


def angular_momentum(body: Body, q: np.ndarray, speed: np.ndarray) -> float:
    """About y, through the centre of mass."""
    import pinocchio as pin

    return float(pin.computeCentroidalMomentum(body.model, body.model.createData(), q, speed).angular[1])

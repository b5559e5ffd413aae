"""The robot of the page: its bodies, a plate in each ankle's place, soles where they are, bushes as measured."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.campaign import scene
from plantar.campaign.pictures import look_of
from plantar.motions.plan import Plan
from plantar.report.scene import SceneBody, SceneFoot, SceneMotion
from plantar.results.residuals import Track
from plantar.robot.model import RobotModel


def track(foot: str) -> Track:
    time = np.array([1.0, 2.0, 3.0, 4.0])
    values = {
        "pitch.deflection": np.array([0.01, 0.02, np.nan, 0.04]),
        "roll.deflection": np.array([0.1, 0.2, 0.3, 0.4]),
    }
    support = np.array(["double", "single", "single", "air"])
    return Track("sway", "fit", foot, time, np.ones(4, bool), support, values)


def test_bushes_bend_as_measured_and_not_in_the_air() -> None:
    bent = scene._bush(track("left"), np.array([0.0, 1.5, 2.0, 3.5, 9.0]))
    np.testing.assert_allclose(bent, [[0.01, 0.1], [0.015, 0.15], [0.02, 0.2], [0.0, 0.15], [0.0, 0.0]])


def drawn(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    seen: list[Any] = []

    def write_scene(path: Path, title: str, bodies: Any, feet: Any, motions: Any) -> Path:
        seen.append((title, bodies, feet, motions))
        return path

    monkeypatch.setattr(scene, "write_scene", write_scene)
    return seen


def test_a_plan_is_drawn_with_its_joints_in_the_bodies_order(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    seen, look = drawn(monkeypatch), look_of(robot)
    joints = tuple(reversed(robot.joint_names))
    positions = np.arange(2.0 * len(joints)).reshape(2, -1)
    stance = {"left": np.eye(4)}
    plan = Plan(
        "sway", np.array([0.0, 1.0]), joints, positions, np.tile(np.eye(4), (2, 1, 1)), frozenset(), stance
    )
    bushes = {"left": np.array([[0.0, 0.0], [0.01, 0.02]])}
    assert scene.write_plan_scene(robot, plan, bushes, tmp_path / "robot.html") == tmp_path / "robot.html"
    ((title, bodies, feet, (motion,)),) = seen
    assert title == "biped on its bushes"
    assert isinstance(motion, SceneMotion)
    assert (motion.name, motion.bushes, motion.stance) == ("sway", bushes, stance)
    for column, name in enumerate(look.joint_names):
        np.testing.assert_array_equal(motion.joints[:, column], positions[:, joints.index(name)])
    assert len(bodies) == len(look.bodies)
    by_name = dict(zip((body.name for body in look.bodies), bodies, strict=True))
    for body, shown in zip(look.bodies, bodies, strict=True):
        assert isinstance(shown, SceneBody)
        assert (shown.parent, shown.slides, shown.side) == (body.parent, body.kind == "prismatic", "")
        np.testing.assert_array_equal(shown.pose[:3, 3], body.xyz)
        np.testing.assert_array_equal(shown.pose[:3, :3], body.rotation)
    for foot in feet:
        assert isinstance(foot, SceneFoot)
        assert look.bodies[foot.ankle].name == f"{foot.name}_ankle_roll_body"
        np.testing.assert_allclose(foot.bush[:3, 3], [0, 0, -0.06])
        np.testing.assert_allclose(foot.sole[:3, 3], [0, 0, -0.03], atol=1e-12)
        np.testing.assert_array_equal(foot.corners[:, :2], robot.feet[foot.name].sole.polygon)
        assert not foot.corners[:, 2].any()
        ((centre, size),) = by_name[f"{foot.name}_ankle_roll_body"].boxes
        np.testing.assert_allclose(size, [0.8 * 0.26, 0.8 * 0.16, 0.014])
        np.testing.assert_allclose(centre, [0, 0, -0.06 + 0.012])


def test_a_campaign_is_drawn_motion_by_motion_as_recorded(
    robot: RobotModel, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    seen, look = drawn(monkeypatch), look_of(robot)
    count = len(robot.joint_names)

    def log(start: float) -> SimpleNamespace:
        return SimpleNamespace(
            time=np.array([1.0, 2.0]), positions=lambda _: start + np.arange(2.0 * count).reshape(2, -1)
        )

    monkeypatch.setattr(scene, "planned", lambda name, _: SimpleNamespace(stance={name: np.eye(4)}))
    monkeypatch.setattr(scene, "residuals_path", lambda folder: folder / "residuals.csv")
    monkeypatch.setattr(
        scene, "read_residuals", lambda path: (track("left"),) if path.parent == tmp_path else ()
    )
    campaign = SimpleNamespace(robot=robot, directory=tmp_path, logs={"sway": log(0.0), "squat": log(100.0)})
    scene.write_campaign_scene(campaign, tmp_path / "robot.html")  # type: ignore[arg-type]
    ((_, _, _, (sway, squat)),) = seen
    np.testing.assert_allclose(sway.bushes["left"], [[0.01, 0.1], [0.02, 0.2]])
    assert (squat.bushes, list(squat.stance)) == ({}, ["squat"])
    order = [list(robot.joint_names).index(name) for name in look.joint_names]
    np.testing.assert_array_equal(squat.joints[0], 100.0 + np.array(order))

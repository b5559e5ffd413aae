"""What logs say of a guess: what does not fit is a doubt."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from example_robots import TALOS
from plantar.errors import RobotError
from plantar.exporters.urdf.tree import UrdfTree
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.logs.save import save_log
from plantar.robot_guess import evidence, guess_robot_file
from plantar.robot_guess.biped import find_biped
from plantar.robot_guess.feet import Sole
from standing_robot import talos_sways


def turned(log: MotionLog, degrees: float) -> MotionLog:
    """The log of a left force sensor that is mounted askew, which no right angle describes."""
    askew = Rotation.from_euler("y", degrees, degrees=True)
    columns = {}
    for place in (0, 3):
        names = wrench_columns("left")[place : place + 3]
        columns |= dict(zip(names, askew.apply(log.stack(names)).T, strict=True))
    return log.with_columns(columns)


@pytest.mark.parametrize(("degrees", "mark"), [(0.0, "# Seen"), (60.0, "# DOUBT")])
def test_wrenches_that_do_not_balance_gravity_are_a_doubt(tmp_path: Path, degrees: float, mark: str) -> None:
    save_log(turned(talos_sways(TALOS), degrees), tmp_path / "sway.csv")
    text = guess_robot_file(TALOS, [tmp_path / "sway.csv"], tmp_path / "robot.yaml")
    (line,) = (line for line in text.splitlines() if "balance gravity" in line)
    assert line.startswith(mark)


CORNERS = np.array([[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]])
WIDENED = "by inertia; widened to hold the centre of pressure"


@pytest.mark.parametrize(
    ("axis", "place", "share", "drawn", "outline", "doubt"),
    [
        (0, 0.12, 0.1, False, (-0.1, 0.13, -0.05, 0.05), None),
        (0, -0.12, 0.1, False, (-0.13, 0.1, -0.05, 0.05), None),
        (1, 0.08, 0.1, False, (-0.1, 0.1, -0.05, 0.09), None),
        (1, -0.08, 0.1, False, (-0.1, 0.1, -0.09, 0.05), None),
        (0, 0.105, 0.1, False, None, None),  # within the 10 mm that no robot uses
        (0, 0.12, 0.1, True, None, "in 10 % of the samples, by 20 mm"),
        (1, -0.08, 0.1, True, None, "in 10 % of the samples, by 30 mm"),
        (0, 0.12, 0.04, True, None, None),
        (0, 0.3, 1.0, False, None, "in 100 % of the samples, by 200 mm"),  # it would fit elsewhere: a zero
    ],
)
def test_an_outline_that_was_guessed_is_widened_one_of_shapes_is_doubted(
    axis: int,
    place: float,
    share: float,
    drawn: bool,
    outline: tuple[float, ...] | None,
    doubt: str | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A centre of pressure in the middle, but for a share of the samples on one side: to it and 10 mm more."""
    points = np.tile([0.0, 0.0, 400.0], (1000, 1))
    points[: round(1000 * share), axis] = place
    points = np.vstack([points, np.tile([9.0, 9.0, 100.0], (500, 1))])  # of a foot that hardly carries
    monkeypatch.setattr(evidence, "pressure", lambda *_: points)
    sole = Sole(SimpleNamespace(side="left"), np.eye(3), CORNERS, -0.1, 0.0, 0.0, "by inertia", drawn)  # type: ignore[arg-type]
    stance = SimpleNamespace(wrenches={"left": None})
    found, doubts = evidence.widen_outline(sole, None, stance, np.eye(4), 800.0)  # type: ignore[arg-type]
    if outline is None:
        assert found == sole
    else:
        x0, x1, y0, y1 = outline
        assert found.corners == pytest.approx(np.array([[x1, y1], [x0, y1], [x0, y0], [x1, y0]]))
        assert found.reason == WIDENED
    assert [one.doubt for one in doubts] == [True] * (doubt is not None)
    assert (
        doubt is None or f"the left foot's centre of pressure leaves its outline {doubt}:" in doubts[0].text
    )


@pytest.mark.parametrize(("links", "found"), [
    ('<link name="right_foot"/>', "right"), ('<link name="left_sole"/>', "left"), ('<link name="foot"/>', "right"),
    ('<link name="plate"/><link name="left_foot"/><joint name="a" type="fixed"><parent link="left_foot"/>'
     '<child link="plate"/></joint>', "left"),
    ('<link name="box"/>', r"rig\.urdf: is no biped: it has no joints, and 'box' is not called a foot \(valid: two "
r"legs, or one foot\)$"), ("", r"rig\.urdf: has no links \(valid: a biped\)$"),
])  # fmt: skip
def test_a_foot_alone_on_a_rig_is_the_root_of_a_urdf_without_joints(
    links: str, found: str, tmp_path: Path
) -> None:
    path = tmp_path / "rig.urdf"
    path.write_text(f'<robot name="rig">{links}</robot>')
    tree, model = UrdfTree.load(path), pin.Model()
    if found in ("left", "right"):
        biped = find_biped(tree, model)
        assert [leg.side for leg in biped.legs] == [found]
    else:
        with pytest.raises(RobotError, match=found):
            find_biped(tree, model)

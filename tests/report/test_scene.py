"""The page of a moving robot: what its script reads, by number; and robots drawn as boxes, near ones over far ones."""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from plantar.report.scene import SceneBody, SceneFoot, SceneMotion, write_scene


def scene_of(path: Path) -> dict[str, Any]:
    """The data that a written page holds."""
    (found,) = re.findall(r'<script[^>]*id="scene"[^>]*>(.*?)</script>', path.read_text(), re.S)
    data: dict[str, Any] = json.loads(found)
    return data


def shifted(x: float, y: float, z: float) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def test_a_scene_holds_bodies_feet_and_ten_frames_a_second(tmp_path: Path) -> None:
    time = np.arange(201) / 100.0
    joints = np.column_stack([0.3 * time, -0.1 * time])
    left = np.column_stack([0.01 * time, np.where(time == 0.55, np.nan, -0.02 * time)])
    motion = SceneMotion("sway", time + 5.0, joints, {"left": left}, {"left": shifted(0, 0.1, 0)})
    bodies = [
        SceneBody(-1, shifted(0, 0, 0.8), np.array([0, 0, 1.0]), False, (), ""),
        SceneBody(0, shifted(0, 0.1234567, -0.4), np.array([0, 1.0, 0]), True,
                  ((np.array([0, 0, 0.1]), np.array([0.2, 0.1, 0.4])),), "left"),
    ]  # fmt: skip
    feet = [SceneFoot(name, 1, shifted(0.01, 0, -0.05), shifted(0, 0, -0.03), np.array([[0.1, 0.05, 0.0]]))
            for name in ("left", "right")]  # fmt: skip
    path = write_scene(tmp_path / "robot.html", "biped on its bushes", bodies, feet, [motion])
    assert path == tmp_path / "robot.html"
    assert "<title>biped on its bushes" in path.read_text()
    data = scene_of(path)
    told = [(one["parent"], one["slides"], one["side"]) for one in data["bodies"]]
    assert told == [(-1, False, ""), (0, True, "left")]
    assert data["bodies"][1]["pose"] == [1, 0, 0, 0, 0, 1, 0, 0.123457, 0, 0, 1, -0.4]
    assert data["bodies"][1]["axis"] == [0, 1, 0]
    assert data["bodies"][1]["boxes"] == [[[0, 0, 0.1], [0.2, 0.1, 0.4]]]
    assert [(one["name"], one["ankle"], one["corners"]) for one in data["feet"]] == [
        (name, 1, [[0.1, 0.05, 0.0]]) for name in ("left", "right")
    ]
    assert data["feet"][0]["bush"][3::4] == [0.01, 0, -0.05]
    assert data["feet"][0]["sole"][3::4] == [0, 0, -0.03]
    (moved,) = data["motions"]
    assert (moved["name"], moved["frames"], data["rate"]) == ("sway", 20, 10.0)
    assert moved["stance"]["left"][3::4] == [0, 0.1, 0]
    codes = np.frombuffer(base64.b64decode(moved["data"]), "<i2").reshape(20, 6)
    at = np.arange(20) / 10
    wanted = np.column_stack([0.3 * at, -0.1 * at, 0.01 * at, -0.02 * at, 0 * at, 0 * at])
    np.testing.assert_allclose(codes * data["step"], wanted, atol=1.01e-4)  # half a step
    assert moved["largest"] == pytest.approx(0.02 * 1.9)


def test_angles_beyond_the_codes_stay_at_their_end(tmp_path: Path) -> None:
    time = np.array([0.0, 1.0])
    motion = SceneMotion("far", time, np.array([[-9.0, 9.0], [-9.0, 9.0]]), {}, {})
    foot = SceneFoot("left", 0, np.eye(4), np.eye(4), np.zeros((1, 3)))
    data = scene_of(write_scene(tmp_path / "far.html", "far", [], [foot], [motion]))
    codes = np.frombuffer(base64.b64decode(data["motions"][0]["data"]), "<i2").reshape(-1, 4)
    assert np.unique(codes, axis=0).tolist() == [[-32767, 32767, 0, 0]]


def test_near_boxes_are_drawn_over_far_ones_in_their_sides_colours() -> None:
    pytest.importorskip("matplotlib")
    from matplotlib.colors import to_hex

    from plantar.report.figures.robot_drawing import SIDES, Box, stances

    corners = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (0, 0.5)])
    boxes = [
        Box(corners + [0.4, 0, 0], "right"),
        Box(corners + [0, 0.3, 0.2], "left"),
        Box(corners - [0.2, 0, 0], side=""),
    ]
    figure = stances([("one", boxes), ("other", boxes[1:])])
    front, beside, side, _ = figure.axes
    drawn = [to_hex(patch.get_edgecolor()) for patch in front.patches]
    colours = dict(zip(("", "left", "right"), drawn, strict=True))
    assert len(set(colours.values())) == 3
    order = [to_hex(patch.get_edgecolor()) for patch in side.patches]
    assert order[-1] == colours["left"], "seen from the left it is the nearest"
    assert colours["right"] == to_hex(SIDES["right"]), "and from the front"
    for patch in front.patches:
        edge, face = np.array(patch.get_edgecolor()[:3]), np.array(patch.get_facecolor()[:3])
        np.testing.assert_allclose(face, 0.55 + 0.45 * edge, atol=1e-6)
    assert front.get_ylim() == side.get_ylim() == pytest.approx((-0.03, 0.73))
    assert front.get_xlim() == beside.get_xlim() == pytest.approx((0.43, -0.13))
    assert side.get_xlim() == pytest.approx((-0.33, 0.53))
    assert [panel.get_title() for panel in (front, beside)] == ["one", "other"]
    left = next(patch for patch in front.patches if to_hex(patch.get_edgecolor()) == colours["left"])
    assert np.ptp(left.get_xy(), axis=0) == pytest.approx((0.2, 0.5))
    assert left.get_xy().min(axis=0) == pytest.approx((0.2, 0.2))
    assert (front.get_xlabel(), side.get_xlabel()) == ("y, left [m]", "x, forward [m]")
    assert (front.get_ylabel(), side.get_ylabel()) == ("from the front, z [m]", "from its left, z [m]")


def test_the_planned_way_of_the_zmp_lies_over_the_measured_one() -> None:
    pytest.importorskip("matplotlib")
    from plantar.report.figures.simulation import GREEN, zmp_planned

    measured = np.array([[0.0, 0.1], [0.01, 0.12]])
    planned = np.array([[0.0, 0.1], [0.02, 0.11], [0.03, 0.12]])
    outline = np.array([[0.1, 0.2], [-0.1, 0.2], [-0.1, 0.0], [0.1, 0.0]])
    figure = zmp_planned(measured, planned, {"left": outline}, outline)
    (panel,) = figure.axes
    line, before = panel.lines[-1], panel.lines[-2]
    assert line.get_color() == GREEN
    np.testing.assert_allclose(np.column_stack(line.get_data()), planned[:, ::-1])
    np.testing.assert_allclose(np.column_stack(before.get_data()), measured[:, ::-1])
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["measured", "planned"]
    assert [handle.get_color() for handle in legend.legend_handles] == [before.get_color(), GREEN]  # type: ignore[union-attr]

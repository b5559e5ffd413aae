"""The robot in motion as one HTML file: its bushes bend more than they do, so that one can see them bend."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np

from plantar.conventions import Array
from plantar.files import write_text
from plantar.report.page import render

RATE: Final = 10.0  # frames a second
ANGLE_STEP: Final = 2e-4  # rad, of the 16-bit codes
LARGEST: Final = 32767


@dataclass(frozen=True)
class SceneBody:
    """A rigid body: its parent (-1: the root), its joint's pose (4, 4) in the parent at zero, the joint's axis (3,)
    and whether it slides; boxes as (centre, full size) [m] in its frame; `side` is "right", "left" or ""."""

    parent: int
    pose: Array
    axis: Array
    slides: bool
    boxes: tuple[tuple[Array, Array], ...]
    side: str


@dataclass(frozen=True)
class SceneFoot:
    """A foot: the ankle's body, the bush's pose (4, 4) in it, the sole's pose in the bush's frame, its corners (n, 3)
    in the sole's frame."""

    name: str
    ankle: int
    bush: Array
    sole: Array
    corners: Array


@dataclass(frozen=True)
class SceneMotion:
    """A motion of the root's tree: joint positions (N, n) in the order of the bodies after the root, the bush's pitch
    and roll (N, 2) of each foot [rad], and where each standing foot's sole is, (4, 4)."""

    name: str
    time: Array = field(repr=False)
    joints: Array = field(repr=False)
    bushes: dict[str, Array] = field(repr=False)
    stance: dict[str, Array] = field(repr=False)


def write_scene(
    path: Path,
    title: str,
    bodies: Sequence[SceneBody],
    feet: Sequence[SceneFoot],
    motions: Sequence[SceneMotion],
) -> Path:
    """Write the page; it needs no network and no WebGL. Returns its path."""
    data = {
        "bodies": [_body(body) for body in bodies],
        "feet": [_foot(foot) for foot in feet],
        "motions": [_motion(motion, [foot.name for foot in feet]) for motion in motions],
        "rate": RATE,
        "step": ANGLE_STEP,
    }
    scripts = ["scene_robot.js", "scene.js"]
    page = render(
        "scene.html.j2", styles=["report.css", "scene.css"], scripts=scripts, title=title, scene=data
    )
    write_text(path, page)
    return path


def _body(body: SceneBody) -> dict[str, Any]:
    return {
        "parent": body.parent,
        "pose": _numbers(body.pose[:3]),
        "axis": _numbers(body.axis),
        "slides": body.slides,
        "boxes": [[_numbers(centre), _numbers(size)] for centre, size in body.boxes],
        "side": body.side,
    }


def _foot(foot: SceneFoot) -> dict[str, Any]:
    matrices = {"bush": _numbers(foot.bush[:3]), "sole": _numbers(foot.sole[:3])}
    return {"name": foot.name, "ankle": foot.ankle, "corners": [_numbers(c) for c in foot.corners]} | matrices


def _motion(motion: SceneMotion, feet: Sequence[str]) -> dict[str, Any]:
    """Frames at RATE: joints, then each foot's pitch and roll, as 16-bit codes, frame after frame."""
    frames = np.arange(motion.time[0], motion.time[-1], 1 / RATE)
    still = np.zeros((motion.time.size, 2))
    tracks = np.column_stack(
        [motion.joints, *(np.nan_to_num(motion.bushes.get(name, still)) for name in feet)]
    )
    sampled = np.column_stack([np.interp(frames, motion.time, track) for track in tracks.T])
    codes = np.clip(np.round(sampled / ANGLE_STEP), -LARGEST, LARGEST).astype("<i2")
    return {
        "name": motion.name,
        "frames": len(frames),
        "stance": {name: _numbers(pose[:3]) for name, pose in motion.stance.items()},
        "largest": float(np.abs(sampled[:, motion.joints.shape[1] :]).max()),
        "data": base64.b64encode(codes.tobytes()).decode("ascii"),
    }


def _numbers(array: Array) -> list[float]:
    return [round(float(value), 6) for value in np.ravel(array)]

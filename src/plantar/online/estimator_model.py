"""The file that the native estimator is constructed from: what it must know of a robot, without URDF and YAML.

One fact a line, a word and its values; frames are nine numbers of rotation, row by row, and three of origin [m].
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from plantar.contact.deflection import FootPath, path_to
from plantar.contact.polygon import convex_hull
from plantar.conventions import GRAVITY, ROTATIONAL_AXES, Array, Axis
from plantar.errors import RobotError
from plantar.robot.model import RobotModel, check_feet

SCHEMA = "plantar.foot_estimator/1"
SLIDE = 0.003  # m, by which a loaded bush is compressed, where nobody has measured it


@dataclass(frozen=True)
class Element:
    """A Jenkins element beside a bush: slip angle [rad], slip torque with its deviation [N·m]."""

    slip_angle: float
    torque: float
    torque_std: float


def estimator_model(
    robot: RobotModel,
    *,
    cutoff: float,
    wrench_delay: tuple[float, float],
    elements: Mapping[tuple[str, Axis], Element],
    compliance: Mapping[str, float],
    linear: Collection[tuple[str, Axis]],
    misplaced: Mapping[tuple[str, Axis], Sequence[float]],
    bends: Mapping[str, float],
    unsure: Mapping[tuple[str, Axis], Sequence[float]],
) -> str:
    """The text of the model file.

    cutoff: of the filters before the regressions [Hz]; wrench_delay: of the force sensors behind the IMU, and
    its deviation [s]; elements: Jenkins elements by foot and axis;
    compliance: of the slides by foot [m/N]; linear: feet and axes in which a batch fit has found no memory;
    misplaced: by foot and axis, how far a batch fit has found the bush's centre aside and above [m], the sensor turned
    and leaning [rad]; bends: by how much a joint bends beyond its encoder [rad/(N.m)]; unsure: by foot and axis, the
    deviations of stiffness and damping that this leaves [share].

    Raises RobotError where the robot file names no IMU or no feet.
    """
    check_feet(robot)
    if robot.imu is None:
        raise RobotError("the estimator needs an IMU", path=robot.path, valid="imu: {name: ..., link: ...}")
    known = robot.uncertainty
    lines = [
        SCHEMA,
        f"robot {robot.name.replace(' ', '_')}",
        _line("weight", [robot.mass * GRAVITY]),
        _line("cutoff", [cutoff]),
        _line("wrench_delay", wrench_delay),
        _line("wrench_gain_std", [known.wrench_gain]),
        *(f"joint {name.replace(' ', '_')}" for name in robot.joint_names),
    ]
    for name in robot.feet:
        lines += _foot_lines(robot, name, bends)
        for place, axis in enumerate(ROTATIONAL_AXES):
            if (found := elements.get((name, axis))) is not None:
                lines.append(
                    f"element {place} " + _numbers([found.slip_angle, found.torque, found.torque_std])
                )
            elif (name, axis) in linear:
                lines.append(f"linear {place}")
            if any(placed := misplaced.get((name, axis), ())):
                lines.append(f"misplaced {place} " + _numbers(placed))
            if any(shares := unsure.get((name, axis), ())):
                lines.append(f"unsure {place} " + _numbers(shares))
        lines += _place_lines(robot, name, compliance.get(name, 0.0))
    return "\n".join(lines) + "\n"


def _foot_lines(robot: RobotModel, name: str, bends: Mapping[str, float]) -> Iterator[str]:
    foot = robot.feet[name]
    path, _, to_bush = path_to(robot, name)
    sensor = to_bush * robot.frame(foot.wrench.placement)[1]
    place = np.concatenate([np.asarray(sensor.rotation).ravel(), sensor.translation])
    yield f"foot {name.replace(' ', '_')}"
    yield f"contact {foot.contact}"
    yield from _path_lines(path, [bends.get(joint, 0.0) for joint in robot.joint_names])
    yield _line("bush", path.bush)
    yield _line("sole", path.sole)
    yield _line("sensor", [foot.wrench.sign, *place])
    for corner in convex_hull(foot.sole.polygon):
        yield _line("corner", corner)


def _place_lines(robot: RobotModel, name: str, compliance: float) -> Iterator[str]:
    """How well the bush's centre is known: of a slide that no fit has measured, the load moves it by millimetres."""
    known = robot.uncertainty
    spread = float(np.hypot(known.bush_position, known.wrench_crosstalk))
    # Zeroed under load, a force sensor does not know the load, nor shows a torque that grows with it.
    aside = 0.0 if robot.feet[name].contact == "always" else spread
    weight = robot.mass * GRAVITY
    yield _line("compliance", [compliance, 0.0 if compliance else SLIDE / weight])
    yield _line("place_std", [aside, spread])


def _path_lines(path: FootPath, bends: Sequence[float]) -> Iterator[str]:
    """A joint on the way from an IMU in another leg carries what that leg does: how it bends is left out."""
    for joint, slides, sign, frame in zip(path.joints, path.slides, path.signs, path.frames, strict=True):
        yield f"path {joint} {int(slides)} " + _numbers([sign, *frame])
        if bends[joint] and sign > 0:
            yield _line("bends", [bends[joint]])


def _line(word: str, values: Iterable[float] | Array) -> str:
    return f"{word} {_numbers(values)}"


def _numbers(values: Iterable[float] | Array) -> str:
    """As many digits as bring the same number back."""
    return " ".join(repr(float(value)) for value in values)

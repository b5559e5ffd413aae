"""A robot on bush feet as MJCF text."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final
from xml.etree.ElementTree import Element, SubElement, indent, tostring

import numpy as np

from plantar.conventions import GRAVITY, Array
from plantar.robot.model import Placement, RobotModel
from plantar.twin.bush import Bush, Feet
from plantar.twin.robots.description import Body, Description
from plantar.twin.robots.foot import CutFoot, cut_feet, place_of
from plantar.twin.robots.from_robot import describe
from plantar.twin.robots.urdf import numbers

TIMESTEP: Final = 0.00025  # s; larger ones need a softer floor, which costs stiffness in series
# Contact stiffness and damping, each per unit of mass [1/s², 1/s], and impedance. What the impedance lacks to 1 gives
# way beneath the sole, a spring in series with the bush (0.02 % of K here); from 0.975 on this contact chatters.
FLOOR: Final = (4e6, 4e3, 0.95)
FRICTION: Final = 0.9
CORNER: Final = 0.001  # radius of the sole's contact points [m]
SERVO_ANGLE: Final = 0.01  # a position error that asks for the joint's full torque [rad]
SERVO_TIME: Final = 0.01  # damping over stiffness [s]
ROTOR: Final = 2.5e-3  # reflected rotor inertia per torque limit [kg·m²/(N·m)]
# Kg·m²: a gram at a millimetre; what a URDF gives as less is a point mass, which MuJoCo refuses.
POINT: Final = 1e-9
HAND: Final = ("hand.x", "hand.y", "hand.z")


@dataclass(frozen=True)
class Scene:
    """What stands around the robot and holds it.

    `floor`: contact stiffness and damping per unit of mass, and impedance; `friction` of sole on floor; `held`: where
    an operator's hand holds the robot, through `hand` = spring [N/m] and damper [N·s/m].
    """

    floor: tuple[float, float, float] = FLOOR
    friction: float = FRICTION
    held: Placement | None = None
    hand: tuple[float, float] = (3000.0, 150.0)
    timestep: float = TIMESTEP


def mjcf_text(robot: RobotModel, bushes: Feet | None, scene: Scene, look: Description | None = None) -> str:
    """MJCF of `robot` on `bushes` (None: rigid feet), drawn as `look` (default: rods).

    Joints keep the URDF's names; each foot adds a body `<foot>.sole` with the joints `<foot>.z`,
    `<foot>.pitch`, `<foot>.roll`, in that order. One actuator a joint follows a position, named like the joint;
    the operator's hand adds three.
    """
    description = look or describe(robot)
    feet = cut_feet(description, robot)
    root = Element("mujoco", model=robot.name)
    SubElement(root, "compiler", angle="radian", autolimits="true", balanceinertia="true")
    options = {
        "timestep": f"{scene.timestep:.12g}",
        "gravity": f"0 0 {-GRAVITY}",
        "integrator": "implicitfast",
    }
    option = SubElement(root, "option", options | {"cone": "elliptic", "impratio": "10"})
    # A robot is one island: looking for more takes a tenth of each step.
    SubElement(option, "flag", island="disable")
    SubElement(SubElement(root, "visual"), "global", offwidth="1280", offheight="960")
    world = SubElement(root, "worldbody")
    _add_world(world, scene)
    elements = _add_bodies(world, description, {foot.place: foot.ankle for foot in feet.values()})
    for foot in feet.values():
        _add_sole(
            elements[foot.place], foot, bushes[foot.name] if bushes is not None else None, scene.timestep
        )
    if robot.imu is not None:
        _add_site(elements, "imu", *place_of(description, robot, robot.imu.placement))
    if scene.held is not None:
        _add_site(elements, "held", *place_of(description, robot, scene.held))
    _add_actuators(root, description, scene)
    _add_sensors(root, robot, feet)
    indent(root)
    return tostring(root, encoding="unicode") + "\n"


def pose(matrix: Array) -> dict[str, str]:
    """`pos` and `quat` attributes of a pose (4, 4)."""
    return {"pos": numbers(matrix[:3, 3]), "quat": numbers(quaternion_from_rotation(matrix[:3, :3]))}


def quaternion_from_rotation(rotation: Array) -> Array:
    """Quaternion w x y z of a rotation matrix, by the eigenvector that holds for every angle (Bar-Itzhack)."""
    r = rotation
    k = np.array(
        [
            [r[0, 0] + r[1, 1] + r[2, 2], r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]],
            [r[2, 1] - r[1, 2], r[0, 0] - r[1, 1] - r[2, 2], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0]],
            [r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], r[1, 1] - r[0, 0] - r[2, 2], r[1, 2] + r[2, 1]],
            [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], r[2, 2] - r[0, 0] - r[1, 1]],
        ]
    )
    vector = np.linalg.eigh(k)[1][:, -1]
    return np.asarray(vector * (1 if vector[0] >= 0 else -1))


def _add_world(world: Element, scene: Scene) -> None:
    floor = {"name": "floor", "type": "plane", "size": "5 5 0.1", "rgba": "0.85 0.85 0.85 1"}
    stiffness, damping, impedance = scene.floor
    touch = {
        "contype": "0",
        "conaffinity": "1",
        "solref": f"{-stiffness:.12g} {-damping:.12g}",
        "solimp": f"{impedance:.12g} {impedance:.12g}",
    }
    # priority: the floor's numbers hold, whatever the sole's are
    SubElement(
        world, "geom", floor | touch | {"friction": f"{scene.friction:.12g} 0.005 0.0001", "priority": "1"}
    )
    SubElement(world, "light", pos="1 -1 4", dir="-0.2 0.2 -1", directional="true")
    SubElement(world, "site", name="world")


def _add_bodies(world: Element, description: Description, ankles: Mapping[int, Body]) -> list[Element]:
    elements: list[Element] = []
    for place, whole in enumerate(description.bodies):
        body = ankles.get(place, whole)
        matrix = np.eye(4)
        matrix[:3, :3], matrix[:3, 3] = body.rotation, body.xyz
        parent = elements[body.parent] if body.parent >= 0 else world
        element = SubElement(parent, "body", {"name": body.name} | pose(matrix))
        elements.append(element)
        if body.parent < 0:
            SubElement(element, "freejoint", name="base")
        else:
            kind = "hinge" if body.kind == "revolute" else "slide"
            limits = {"range": f"{body.lower:.12g} {body.upper:.12g}"} if np.isfinite(body.lower) else {}
            rotor = f"{ROTOR * body.effort:.12g}"
            names = {"name": body.joint, "type": kind, "axis": numbers(body.axis), "armature": rotor}
            SubElement(element, "joint", names | limits)
        _add_inertia(element, body)
        for shape in body.shapes:
            colour = {"rgba": "0.55 0.65 0.75 1", "contype": "0", "conaffinity": "0", "mass": "0"}
            box = {"type": "box", "pos": numbers(shape.xyz), "size": numbers(shape.size / 2)}
            SubElement(element, "geom", box | colour)
    return elements


def _add_inertia(element: Element, body: Body) -> None:
    i = body.inertia
    full = [i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2]]
    mass = max(body.mass, 1e-4)  # a link that only carries a frame
    if np.linalg.eigvalsh(i)[0] < POINT:
        full = [1e-7, 1e-7, 1e-7, 0.0, 0.0, 0.0]
    SubElement(
        element, "inertial", pos=numbers(body.com), mass=f"{mass:.12g}", fullinertia=numbers(np.array(full))
    )


def _add_sole(ankle: Element, foot: CutFoot, bush: Bush | None, timestep: float) -> None:
    """The sole below the bush: z slide, pitch and roll in series, in one light body (none may be massless)."""
    sole = SubElement(ankle, "body", {"name": f"{foot.name}.sole"} | pose(foot.bush))
    centre = {
        "pos": "0 0 0",
        "mass": f"{foot.mass:.12g}",
        "diaginertia": numbers(_sole_inertia(foot, bush, timestep)),
    }
    SubElement(sole, "inertial", centre)
    if bush is not None:
        axes = (
            ("z", "slide", "0 0 1", bush.z_stiffness, bush.z_damping),
            ("pitch", "hinge", "0 1 0", bush.pitch_stiffness, bush.pitch_damping),
            ("roll", "hinge", "1 0 0", bush.roll_stiffness, bush.roll_damping),
        )
        for name, kind, axis, stiffness, damping in axes:
            spring = {"stiffness": f"{stiffness:.12g}", "damping": f"{damping:.12g}"}
            SubElement(sole, "joint", {"name": f"{foot.name}.{name}", "type": kind, "axis": axis} | spring)
    SubElement(sole, "site", name=f"{foot.name}.bush")
    low, high = foot.corners.min(axis=0), foot.corners.max(axis=0)
    plate = {"type": "box", "rgba": "0.15 0.15 0.15 1", "contype": "0", "conaffinity": "0", "mass": "0"}
    middle, size = (low + high) / 2 + [0, 0, 0.008], np.maximum((high - low) / 2, 0.008)
    SubElement(sole, "geom", plate | {"pos": numbers(middle), "size": numbers(size)})
    # contact at the corners only: a plate on a plane has no other points that matter, and nothing else of the
    # robot collides, so ankle and sole never touch each other
    for corner in foot.corners:
        touch = {"type": "sphere", "size": str(CORNER), "contype": "1", "conaffinity": "0", "mass": "0"}
        SubElement(sole, "geom", touch | {"pos": numbers(corner + [0, 0, CORNER]), "condim": "3"})


def _sole_inertia(foot: CutFoot, bush: Bush | None, timestep: float) -> Array:
    """Principal moments of the sole, (3,) [kg·m²], with which it does not rattle between its edges on a bush.

    The integrator takes the bush's damping implicitly, the contact's forces are found without it: they turn a sole of
    inertia I by I / (I + timestep C) of what they should. Below a half the contact bounces, for as long as the sole
    stands. A sole that stands flat does not turn, so that more inertia than the real one's changes nothing else.
    """
    inertia = np.array(foot.inertia)
    if bush is not None:
        inertia[:2] = np.maximum(inertia[:2], timestep * np.array([bush.roll_damping, bush.pitch_damping]))
        inertia[2] = max(inertia[2], abs(inertia[0] - inertia[1]))
    return inertia


def _add_site(elements: list[Element], name: str, place: int, matrix: Array) -> None:
    SubElement(elements[place], "site", {"name": name} | pose(matrix))


def _add_actuators(root: Element, description: Description, scene: Scene) -> None:
    actuators = SubElement(root, "actuator")
    for body in description.bodies[1:]:
        stiffness = body.effort / SERVO_ANGLE
        servo = {"kp": f"{stiffness:.12g}", "kv": f"{stiffness * SERVO_TIME:.12g}"}
        limit = {"forcerange": f"{-body.effort:.12g} {body.effort:.12g}"}
        SubElement(actuators, "position", {"name": body.joint, "joint": body.joint} | servo | limit)
    if scene.held is not None:
        gears = ("1 0 0 0 0 0", "0 1 0 0 0 0", "0 0 1 0 0 0")
        spring = {"kp": f"{scene.hand[0]:.12g}", "kv": f"{scene.hand[1]:.12g}"}
        for name, gear in zip(HAND, gears, strict=True):
            hand = {"name": name, "site": "held", "refsite": "world", "gear": gear}
            SubElement(actuators, "position", hand | spring)


def _add_sensors(root: Element, robot: RobotModel, feet: Mapping[str, CutFoot]) -> None:
    sensors = SubElement(root, "sensor")
    if robot.imu is not None:
        SubElement(sensors, "framequat", name="imu.orientation", objtype="site", objname="imu")
        SubElement(sensors, "gyro", name="imu.angular_velocity", site="imu")
        SubElement(sensors, "accelerometer", name="imu.linear_acceleration", site="imu")
    for name in feet:
        SubElement(sensors, "force", name=f"{name}.force", site=f"{name}.bush")
        SubElement(sensors, "torque", name=f"{name}.torque", site=f"{name}.bush")
        SubElement(sensors, "framequat", name=f"{name}.sole", objtype="site", objname=f"{name}.bush")
        SubElement(sensors, "framepos", name=f"{name}.place", objtype="site", objname=f"{name}.bush")

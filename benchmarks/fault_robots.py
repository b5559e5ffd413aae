"""Faults of robot files and URDFs: each number off by what people get wrong, and models of another robot."""

from __future__ import annotations

import math
import tempfile
from dataclasses import replace
from pathlib import Path

from fault_case import FEET, Case, Fault, case_of
from fault_robot_changes import (
    ankle_above,
    bent_ankles,
    feet_exchanged,
    frame,
    imu_frame,
    imu_on_root,
    longer_shanks,
    masses,
    mirrored_hip,
    negative_sign,
    sensors_elsewhere,
    soles,
    trunk_mass,
    turned_axis,
    untold_gears,
    urdf,
    without_arm,
)
from fault_twins import other_robot

DEGREE = math.pi / 180
X, Y, Z = range(3)
PLACE = ("bush", "wrench", "sole", "position", "moment arm", "height", "guess", "balance", "geometry")
MODEL = ("weigh", "mass", r"carry .* kg", "balance", "URDF", "sign", "leans", "swapped", "joint")
TURN = ("turned", "sign", "balance", "leans", "rpy", "frame", "mount")

GEOMETRY = (
    *(Fault(f"bushes {100 * by:+.0f} cm in z", "geometry", frame("bush", "xyz", Z, by), PLACE)
      for by in (-0.03, -0.01, 0.01, 0.02, 0.03)),
    Fault("left bush +3 cm in z", "geometry", frame("bush", "xyz", Z, 0.03, "left"), PLACE),
    Fault("bushes +3 cm in x", "geometry", frame("bush", "xyz", X, 0.03), PLACE),
    Fault("bushes +2 cm in y", "geometry", frame("bush", "xyz", Y, 0.02), PLACE),
    Fault("bushes turned by 10 deg about z", "geometry", frame("bush", "rpy", Z, 10 * DEGREE), (*PLACE, *TURN)),
    Fault("bushes turned by 90 deg about z", "geometry", frame("bush", "rpy", Z, 90 * DEGREE), (*PLACE, *TURN)),
    *(Fault(f"wrenches {100 * by:+.0f} cm in z", "geometry", frame("wrench", "xyz", Z, by), PLACE)
      for by in (-0.03, -0.01, 0.01, 0.03)),
    Fault("wrenches at the ankle or sole", "geometry", lambda case: case.with_robot(sensors_elsewhere), PLACE),
    Fault("wrenches +3 cm in x", "geometry", frame("wrench", "xyz", X, 0.03), PLACE),
    Fault("left wrench +2 cm in y", "geometry", frame("wrench", "xyz", Y, 0.02, "left"), PLACE),
    *(Fault(f"wrenches turned by {by} deg about z", "geometry", frame("wrench", "rpy", Z, by * DEGREE), TURN)
      for by in (5, 15, 90, 180)),
    Fault("left wrench turned by 90 deg about z", "geometry", frame("wrench", "rpy", Z, 90 * DEGREE, "left"), TURN),
    Fault("wrenches turned by 10 deg about y", "geometry", frame("wrench", "rpy", Y, 10 * DEGREE), TURN),
    Fault("wrenches' sign reversed", "geometry", lambda case: case.with_robot(negative_sign), ("sign",)),
    Fault("soles 3 cm lower", "geometry", frame("sole", "xyz", Z, -0.03), PLACE),
    Fault("soles half as large", "geometry", soles(0.5), (*PLACE, "tip", "edge")),
    Fault("soles larger by half", "geometry", soles(1.5), (*PLACE, "tip", "edge")),
    Fault("soles in mm", "geometry", soles(1000), (*PLACE, "polygon", "unit")),
    Fault("IMU +5 cm in z", "geometry", imu_frame("xyz", Z, 0.05), (*TURN, "imu")),
    *(Fault(f"IMU turned by {by} deg about z", "geometry", imu_frame("rpy", Z, by * DEGREE), TURN)
      for by in (5, 10, 30, 90, 180)),
    Fault("IMU turned by 5 deg about y", "geometry", imu_frame("rpy", Y, 5 * DEGREE), TURN),
    Fault("IMU upside down", "geometry", imu_frame("rpy", X, math.pi), TURN),
    Fault("IMU on another link", "geometry", imu_on_root, (*TURN, "imu")),
    Fault("left ankle a link too high", "geometry", ankle_above, (*PLACE, *MODEL)),
    Fault("feet exchanged", "geometry", lambda case: case.with_robot(feet_exchanged), (*PLACE, *MODEL)),
)  # fmt: skip


def _mirrored(axis: list[float]) -> list[float]:
    return [-part for part in axis]


def another_robot(case: Case) -> Case:
    """Robot file and URDF of another robot, with sensors called as in the logs."""
    with tempfile.TemporaryDirectory() as folder:
        name = "hrp2" if case.robot["name"].startswith("hrp2") else case.robot["name"]
        other = case_of(other_robot(name, Path(folder)), {})
    for foot in FEET:
        other.robot["feet"][foot]["wrench"]["name"] = case.robot["feet"][foot]["wrench"]["name"]
    other.robot["imu"]["name"] = case.robot["imu"]["name"]
    return replace(case, robot=other.robot, urdf=other.urdf)


KNEE, ANKLE_PITCH = -3, -2
MODELS = (
    Fault("masses -20 %", "model", masses(0.8), MODEL),
    Fault("masses +10 %", "model", masses(1.1), MODEL),
    Fault("trunk +10 kg", "model", trunk_mass(10.0), MODEL),
    Fault("an arm missing", "model", urdf(without_arm), MODEL),
    Fault("ankles bend by 1e-4 rad/(N·m), said", "model", bent_ankles(1e-4), ("joint compliance",)),
    *(Fault(f"joints bend by {by:.0e} rad/(N·m), unsaid", "model", untold_gears(by), ("bend",))
      for by in (5e-5, 1e-4, 2e-4)),
    Fault("shanks 2 cm longer", "model", longer_shanks(0.02), MODEL),
    Fault("left knee's axis mirrored", "model", turned_axis(KNEE, _mirrored, "left"), MODEL),
    Fault("ankle pitch axes mirrored", "model", turned_axis(ANKLE_PITCH, _mirrored, *FEET), MODEL),
    Fault("left ankle's axis about another direction", "model",
          turned_axis(ANKLE_PITCH, lambda axis: axis[1:] + axis[:1], "left"), MODEL),
    Fault("left hip on the right side", "model", urdf(mirrored_hip), MODEL),
    Fault("another robot", "model", another_robot, ("joint",)),
)  # fmt: skip

OF_ROBOTS = (*GEOMETRY, *MODELS)

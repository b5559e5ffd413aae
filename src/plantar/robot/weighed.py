"""A robot that was weighed: its URDF's masses scaled to what the balance says."""

from __future__ import annotations

from pathlib import Path

import pinocchio as pin

from plantar.conventions import NORMAL95
from plantar.errors import RobotError
from plantar.notes import Note

FARTHEST = 2.0  # times the URDF's weight, or its half: beyond, the number is another unit or another robot


def of_mass(model: pin.Model, mass: float | None) -> pin.Model:
    """The model with every mass and moment of inertia scaled so that it weighs `mass` [kg]; as it is for None.

    Centres of mass stay where they are: what a battery or a cover adds, and where, a balance does not say.
    """
    if mass is None:
        return model
    share = mass / weight_of(model)
    for joint, inertia in enumerate(model.inertias):
        model.inertias[joint] = pin.Inertia(share * inertia.mass, inertia.lever, share * inertia.inertia)
    return model


def weight_of(model: pin.Model) -> float:
    """Total mass of a model [kg]."""
    return float(sum(inertia.mass for inertia in model.inertias))


def check_weight(path: Path, weighed: float | None, urdf: float) -> None:
    """Raises RobotError where the URDF weighs nothing, or the weighed mass [kg] cannot be that of its robot."""
    if urdf <= 0:
        valid = "links with an <inertial>: contact and delays follow from the robot's weight"
        raise RobotError("urdf: its links weigh nothing", path=path, valid=valid)
    if weighed is not None and not urdf / FARTHEST <= weighed <= urdf * FARTHEST:
        text = f"mass: the URDF weighs {urdf:.4g} kg"
        raise RobotError(text, path=path, value=weighed, valid="what a balance says of this robot, in kg")


def weight_notes(file: str, weighed: float | None, urdf: float, deviation: float) -> list[Note]:
    """A note where the URDF weighs something else than the balance says, which is right to the share `deviation`."""
    if weighed is None or abs(urdf / weighed - 1) <= NORMAL95 * deviation:
        return []
    text = (
        f"{file}: the robot was weighed as {weighed:.4g} kg, its URDF weighs {urdf:.4g} kg: masses and moments of "
        f"inertia are taken as {weighed / urdf:.3g} times the URDF's"
    )
    return [Note("weighed", "info", text)]

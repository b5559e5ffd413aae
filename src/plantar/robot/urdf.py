"""A URDF as text and as Pinocchio's model, and what is said of one that cannot be used."""

from __future__ import annotations

import difflib
import re
from pathlib import Path

import pinocchio as pin

from plantar.errors import RobotError, located
from plantar.files import read_bounded

LIMIT = 64 * 2**20  # bytes


def read_urdf(path: Path) -> str:
    """The text of a URDF. Raises RobotError where it cannot be read or is no text."""
    try:
        return read_bounded(path, LIMIT, RobotError).decode()
    except UnicodeDecodeError as error:
        raise RobotError(located("is not UTF-8 text", path=path, valid="a URDF")) from error


def parse_urdf(urdf: str, path: Path, *, floating: bool) -> pin.Model:
    """Pinocchio's model of a URDF's text, with a free-flyer above the root link where `floating`.

    Raises RobotError, with `path` for the file, where it declares an entity or Pinocchio cannot read it.
    """
    if re.search(r"<!(DOCTYPE|ENTITY)", urdf, re.IGNORECASE):
        raise RobotError(located("declares a DOCTYPE or an entity", path=path, valid="plain URDF"))
    root = [pin.JointModelFreeFlyer()] if floating else []
    try:
        return pin.buildModelFromXML(urdf, *root)
    except (ValueError, RuntimeError, IndexError) as error:
        reason = str(error).splitlines()[0] if str(error) else "unreadable"
        raise RobotError(located(f"is not a readable URDF: {reason}", path=path)) from error


def unknown_link(link: str, model: pin.Model, path: Path) -> str:
    """One line that names an unknown link and what may have been meant."""
    names = [frame.name for frame in model.frames]
    near = difflib.get_close_matches(link, names, n=3)
    valid = "one of " + ", ".join(near) if near else f"a frame of the URDF, such as {', '.join(names[1:4])}"
    return located(f"link '{link}' is not in the URDF", path=path, valid=valid)

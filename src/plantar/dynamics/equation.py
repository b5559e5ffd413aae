"""Equation 1 of one robot, evaluated in batches by the native core.

    [Y_BI   0 ] [phi_I]   [ 0 ]         [K_Bk]
    [Y_JI Y_JJ] [phi_J] = [tau] + sum_k [K_Jk] F_k

A fixed base has no Y_BI. Rows are Pinocchio's velocities: for a floating base the root link's wrench (force,
then torque about its origin, in its axes), then the joints in the model's order.
"""

from __future__ import annotations

import atexit
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
import pinocchio as pin

from plantar import _core
from plantar.conventions import INERTIAL_NAMES, Array
from plantar.dynamics.motion import Motion
from plantar.robot.kinematics import KinematicTree, packed_frame

BASE_ROWS: Final = 6
PER_LINK: Final = len(INERTIAL_NAMES)
ALL_PARAMETERS: Final = (1 << PER_LINK) - 1


@dataclass(frozen=True)
class Contact:
    """Where a wrench acts: `link`, an index into `Equation.links`, and the placement of its frame in that link."""

    link: int
    placement: pin.SE3


class Equation:
    """Eq. 1 of a Pinocchio model, with or without free-flyer.

    links: names of what carries inertial parameters, in Pinocchio's order, fixed links lumped in; rest: the
    root frame's motion at rest and level, (9,), as in `Motion.base`. Raises RobotError naming a joint that is
    not revolute, continuous or prismatic.
    """

    def __init__(self, model: pin.Model) -> None:
        self.tree = KinematicTree.from_model(model)
        self.floating = self.tree.floating
        self.links = link_names(model)
        self.rest: Array = np.concatenate([-np.asarray(model.gravity.linear), np.zeros(6)])
        frames = [
            np.concatenate([rotation.ravel(), translation])
            for rotation, translation in zip(self.tree.rotations, self.tree.translations, strict=True)
        ]
        self.core = _core.Tree(
            [int(parent) for parent in self.tree.parents],
            [bool(slides) for slides in self.tree.slides],
            [np.ascontiguousarray(axis) for axis in self.tree.axes],
            frames,
            self.floating,
        )

    @property
    def n_rows(self) -> int:
        return (BASE_ROWS if self.floating else 0) + len(self.tree)

    @property
    def first_joint_row(self) -> int:
        return BASE_ROWS if self.floating else 0

    def parent_link(self, link: int) -> int:
        """The link that carries this one, -1 for the world or for a floating root."""
        first = 1 if self.floating else 0
        return -1 if link < first else int(self.tree.parents[link - first]) + first

    def regressor(self, motion: Motion, kept: Sequence[int] | None = None, threads: int = 0) -> Array:
        """Y of eq. 1, dense: (n_rows, columns, N), the samples along the last axis.

        kept: for each link a bit mask of the parameters that have a column; all ten by default.
        """
        masks = [ALL_PARAMETERS] * len(self.links) if kept is None else list(kept)
        rows = [True] * self.n_rows
        m = motion
        return _core.regressor(
            self.core, masks, rows, m.base, m.positions, m.velocities, m.accelerations, threads
        )

    def inverse_dynamics(
        self,
        motion: Motion,
        parameters: Array | None,
        contacts: Sequence[Contact] = (),
        wrenches: Sequence[Array] = (),
    ) -> Array:
        """Y phi_I less what the contacts carry, (n_rows, N) [N, N·m].

        parameters: 10 a link, (10 n_links,); None leaves Y phi_I out. wrenches: (N, 6) for each contact, of
        the environment on the robot, in the contact's frame.
        """
        m = motion
        return _core.inverse_dynamics(
            self.core,
            None if parameters is None else np.ascontiguousarray(parameters, dtype=np.float64),
            [contact.link for contact in contacts],
            [packed_frame(contact.placement) for contact in contacts],
            list(wrenches),
            m.base,
            m.positions,
            m.velocities,
            m.accelerations,
        )

    def base_wrenches(self, motion: Motion, parameters: Array) -> Array:
        """The first six rows of Y phi_I of a floating base for several sets of parameters at once, (sets, N, 6).

        parameters: (sets, 10 n_links).
        """
        m, given = motion, np.ascontiguousarray(parameters, dtype=np.float64)
        return _core.base_wrenches(self.core, given, m.base, m.positions, m.velocities, m.accelerations)

    def contact_transfer(self, positions: Array, contact: Contact) -> Array:
        """K_B and K_J of one contact, (N, n_rows, 6): contact wrench to base wrench and joint torques."""
        samples = len(positions)
        still = np.zeros((samples, len(self.tree)))
        motion = Motion(np.zeros((samples, 9)), positions, still, still)
        columns = []
        for axis in range(6):
            unit = np.zeros((samples, 6))
            unit[:, axis] = -1.0
            columns.append(self.inverse_dynamics(motion, None, [contact], [unit]).T)
        return np.stack(columns, axis=2)

    def base_transfer(self, positions: Array, contact: Contact) -> Array:
        """K_B of one contact of a floating base alone, (N, 6, 6): the first rows of `contact_transfer`."""
        frame = packed_frame(contact.placement)
        return _core.base_transfer(self.core, contact.link, frame, positions)


@lru_cache(maxsize=1)  # every log asks for that of the one robot
def equation_of(model: pin.Model) -> Equation:
    """The `Equation` of a model that nobody changes."""
    return Equation(model)


# A native object that outlives the interpreter is printed as a leak.
atexit.register(equation_of.cache_clear)


def link_names(model: pin.Model) -> tuple[str, ...]:
    """The link that each of a model's joints moves: its name in the URDF, else the joint's."""
    names = list(model.names)
    found = set()
    for frame in model.frames:
        if frame.type == pin.FrameType.BODY and frame.parentJoint not in found:
            found.add(frame.parentJoint)
            names[frame.parentJoint] = frame.name
    return tuple(names[1:])


def model_parameters(model: pin.Model) -> Array:
    """The inertial parameters of a model's links.

    Args:
        model: the robot.

    Returns:
        (10 n_links,) in Pinocchio's order: m [kg], m·c [kg·m], Ixx Ixy Iyy Ixz Iyz Izz about the joint frame [kg·m²].

    Raises:
        Nothing.

    Example:
        >>> import pinocchio as pin
        >>> from plantar import dynamics
        >>> model = pin.buildSampleModelManipulator()
        >>> dynamics.model_parameters(model).shape == (10 * (model.njoints - 1),)
        True
    """
    parameters = [inertia.toDynamicParameters() for inertia in list(model.inertias)[1:]]
    return np.concatenate(parameters) if parameters else np.zeros(0)

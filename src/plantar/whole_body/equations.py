"""The rows of eq. 2 and 3 over one log: the contacts' wrenches on one side, motion and joint terms on the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from plantar.conventions import Array
from plantar.dynamics import Contact, Motion
from plantar.whole_body.dataset import Body, Whole
from plantar.whole_body.folds import Samples

DISSIPATIVE = ("viscous", "coulomb", "inertia")  # cannot be negative; a spring may, where a pose is unstable

# Of joints that turn, and of those that slide.
TERM_UNITS = {
    "viscous": ("N.m.s/rad", "N.s/m"),
    "coulomb": ("N.m", "N"),
    "offset": ("N.m", "N"),
    "stiffness": ("N.m/rad", "N/m"),
    "inertia": ("kg.m2", "kg"),
}


@dataclass(frozen=True)
class Calibration:
    """What the sensors need: a rotation of the root motion (3, 3); for each foot's sensor that is to be mended a matrix
    (6, 6) from wrench as recorded to wrench."""

    rotation: Array
    sensors: Mapping[str, Array] = field(default_factory=dict)

    def sensor(self, foot: str) -> Array:
        return self.sensors.get(foot, np.eye(6))


def contacts_of(body: Body) -> dict[str, Contact]:
    """Where each foot's sensor sits, as a contact of eq. 1."""
    offset = 0 if body.equation.floating else -1
    found = {}
    for name, foot in body.robot.feet.items():
        joint, placement = body.robot.frame(foot.wrench.placement)
        found[name] = Contact(joint + offset, placement)
    return found


def foot_wrenches(body: Body, whole: Whole, calibration: Calibration) -> dict[str, Array]:
    """Each foot's wrench in its sensor's frame, of the environment on the robot, (N, 6)."""
    return {
        name: foot.wrench.sign * whole.wrenches[name] @ calibration.sensor(name).T
        for name, foot in body.robot.feet.items()
    }


def carried(
    body: Body, whole: Whole, calibration: Calibration, wrenches: Mapping[str, Array] | None = None
) -> Array:
    """What the contacts carry, sum of K F, (n_rows, N): on top, for a floating base, the ground's total wrench.

    wrenches: other ones than those recorded, (N, 6) a foot.
    """
    contacts = contacts_of(body)
    if wrenches is None:
        wrenches = foot_wrenches(body, whole, calibration)
    still = replace(whole.motion, base=np.zeros_like(whole.motion.base))
    return -body.equation.inverse_dynamics(
        still, None, list(contacts.values()), [wrenches[name] for name in contacts]
    )


def turned(motion: Motion, rotation: Array) -> Motion:
    """The same motion with the root frame's part rotated."""
    parts = [motion.base[:, k : k + 3] @ rotation.T for k in (0, 3, 6)]
    return replace(motion, base=np.hstack(parts))


def inertial_samples(body: Body, whole: Whole, calibration: Calibration) -> Samples:
    """The base rows: Y_BI phi_I = sum of K_B F (eq. 2)."""
    rows = carried(body, whole, calibration)
    motion = turned(whole.motion, calibration.rotation)
    samples = Samples(
        whole.log.name, whole.log.time, motion, {k: rows[k] for k in range(6)}, {}, whole.log.period
    )
    return samples.select(whole.valid)


def term_columns(
    terms: Sequence[str], position: Array, velocity: Array, acceleration: Array, sense: Array
) -> tuple[Array, ...]:
    """Y_JJ of one joint: one column (N,) a term; sense: of the motion, as in `Whole`."""
    columns = {
        "viscous": velocity,
        "coulomb": sense,
        "offset": np.ones_like(velocity),
        "stiffness": position,
        "inertia": acceleration,
    }
    return tuple(np.ascontiguousarray(columns[term]) for term in terms)


def joint_samples(
    body: Body, whole: Whole, calibration: Calibration, terms: Mapping[str, tuple[str, ...]]
) -> Samples:
    """The joint rows: Y_JI phi_I + Y_JJ phi_J = tau + sum of K_J F (eq. 3), with the base rows where there are feet.

    terms: of each joint that takes part; one without effort is passive, its torque zero.
    """
    equation = body.equation
    motion = turned(whole.motion, calibration.rotation) if equation.floating else whole.motion
    rows = np.zeros((equation.n_rows, len(whole.log)))
    if body.robot.feet and equation.floating:
        rows = carried(body, whole, calibration)
    measured = {k: rows[k] for k in range(6)} if equation.floating else {}
    extras: dict[int, tuple[Array, ...]] = {}
    for joint, name in enumerate(equation.tree.names):
        if name not in terms:
            continue
        row = equation.first_joint_row + joint
        measured[row] = rows[row] + whole.efforts.get(name, 0.0)
        states = (motion.positions, motion.velocities, motion.accelerations, whole.sense)
        extras[row] = term_columns(terms[name], *(state[:, joint] for state in states))
    rows_of = {name: equation.first_joint_row + joint for joint, name in enumerate(equation.tree.names)}
    positive = {
        rows_of[name]: tuple(term in DISSIPATIVE for term in chosen) for name, chosen in terms.items()
    }
    samples = Samples(whole.log.name, whole.log.time, motion, measured, extras, whole.log.period, positive)
    return samples.select(whole.valid)

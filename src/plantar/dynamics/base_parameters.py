"""Which combinations of inertial parameters move the robot at all: the minimal (base) parameters.

Found from the structure of the tree alone. What a joint cannot tell apart from a change of its parent is handed to the
parent: behind a revolute joint the mass, the first moment along the axis and one moment of inertia; behind a prismatic
joint the whole inertia. For a floating base nothing else is lost. Joints near a fixed base move too little for the
rest: a first axis along gravity, parallel axes. Those columns are found by the rank of eq. 1 over a fixed sequence of
pseudo-random states, the same on every machine, never over a recording.

A base parameter is one parameter of one link (a column of eq. 1 that is kept) plus the shares of those handed to it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plantar.conventions import INERTIAL_NAMES, Array
from plantar.dynamics.equation import PER_LINK, Equation
from plantar.dynamics.motion import Motion

INERTIA_ENTRIES = ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))
"""(row, column) of the inertia matrix for each of its six parameters, in Pinocchio's order."""
_ROWS, _COLUMNS = np.array(INERTIA_ENTRIES).T
Indices = np.ndarray[tuple[int, ...], np.dtype[np.int64]]
DIAGONAL = (4, 6, 9)
"""Ixx, Iyy, Izz among the ten."""
RANK_TOLERANCE = 1e-8  # of a column's norm: what is left of a dependent column
PROBING_SEED = 20111  # of the pseudo-random states that find what a fixed base hides
ROUNDING = 1e-14  # coefficients below it are none
LEGIBLE = 1e-5  # coefficients below it are left out of an expression (not of the numbers)


@dataclass(frozen=True)
class BaseParameters:
    """The minimal parameters of one robot.

    links: names; kept: indices of the kept columns, increasing, (n_base,), 10 a link; grouping: (n_base, 10
    n_links), so that `base = grouping @ inertial` and `Y @ inertial == Y[:, kept] @ base` in every motion.
    """

    links: tuple[str, ...]
    kept: np.ndarray[tuple[int], np.dtype[np.int64]]
    grouping: Array

    def __len__(self) -> int:
        return len(self.kept)

    @property
    def masks(self) -> list[int]:
        """For each link, bit p set where parameter p is kept."""
        masks = [0] * len(self.links)
        for index in self.kept:
            masks[index // PER_LINK] |= 1 << int(index % PER_LINK)
        return masks

    @property
    def expressions(self) -> tuple[str, ...]:
        """Each base parameter as a sum, such as `knee.Izz + 0.09 shin.m`."""
        return tuple(self._expression(row) for row in range(len(self.kept)))

    @property
    def names(self) -> tuple[str, ...]:
        """The kept parameter of each, such as `knee.Izz`."""
        return tuple(parameter_name(self.links, int(index)) for index in self.kept)

    def embed(self, values: Array) -> Array:
        """Parameters (10 n_links,), not physical, that move the robot as these base parameters do."""
        inertial = np.zeros(PER_LINK * len(self.links))
        inertial[self.kept] = values
        return inertial

    def _expression(self, row: int) -> str:
        own = int(self.kept[row])
        text = parameter_name(self.links, own)
        for index in np.flatnonzero(self.grouping[row]):
            share = self.grouping[row, index]
            if index == own or abs(share) < LEGIBLE:
                continue
            size = "" if abs(abs(share) - 1) < LEGIBLE else f"{abs(share):.6g} "
            text += f" {'-' if share < 0 else '+'} {size}{parameter_name(self.links, int(index))}"
        return text


def parameter_name(links: tuple[str, ...], index: int) -> str:
    """`link.parameter` of one of the 10 n_links parameters."""
    return f"{links[index // PER_LINK]}.{INERTIAL_NAMES[index % PER_LINK]}"


def base_parameters(equation: Equation) -> BaseParameters:
    """The minimal parameters of a robot, from its structure alone; the same on every machine.

    Args:
        equation: of the robot, such as `dynamics.Equation(model)`.

    Returns:
        Which of the 10 n_links inertial parameters are kept, and what is added to each.

    Raises:
        RobotError: `Equation` does, for a joint that is not revolute, continuous or prismatic.

    Example:
        >>> import pinocchio as pin
        >>> from plantar import dynamics
        >>> model = pin.buildSampleModelManipulator()
        >>> len(dynamics.base_parameters(dynamics.Equation(model))), 10 * (model.njoints - 1)
        (38, 60)
    """
    size = PER_LINK * len(equation.links)
    first_joint = 1 if equation.floating else 0
    kept = list(range(PER_LINK * first_joint))
    # expressed[k]: column k of eq. 1 as a sum of the kept columns, found from the root outwards.
    expressed = np.zeros((size, size))
    expressed[kept, kept] = 1.0
    for joint, (dropped, remaining, onto_parent, onto_own) in enumerate(_shares(equation)):
        start = PER_LINK * (joint + first_joint)
        lost = expressed[start : start + PER_LINK]
        parent = equation.parent_link(joint + first_joint)
        if parent >= 0:
            above = expressed[PER_LINK * parent : PER_LINK * (parent + 1)]
            lost[dropped, : PER_LINK * (parent + 1)] = onto_parent @ above[:, : PER_LINK * (parent + 1)]
        lost[dropped[:, None], start + remaining] = onto_own
        lost[remaining, start + remaining] = 1.0
        kept += (start + remaining).tolist()
    if not equation.floating:
        kept, expressed = _without_hidden(equation, kept, expressed)
    grouping = expressed[:, kept].T.copy()
    grouping[np.abs(grouping) < ROUNDING] = 0.0
    return BaseParameters(equation.links, np.array(kept, dtype=np.int64), grouping)


def _shares(equation: Equation) -> list[tuple[Indices, Indices, Array, Array]]:
    """For each joint: parameters of its link that go, those that stay, and the columns of the former as shares of the
    parent's ten columns and of the latter.

    Y_link mine == Y_parent parents, solved for the columns that go; all joints of a kind at once.
    """
    tree = equation.tree
    shares: dict[int, tuple[Indices, Indices, Array, Array]] = {}
    for slides in (False, True):
        joints = np.flatnonzero(tree.slides == slides)
        if not len(joints):
            continue
        mine, parents = _handed_over(
            slides, tree.axes[joints], tree.rotations[joints], tree.translations[joints]
        )
        dropped = _dropped(slides, tree.axes[joints])
        each = np.arange(len(joints))[:, None]
        remaining = np.ones((len(joints), PER_LINK), dtype=bool)
        remaining[each, dropped] = False
        stay = np.nonzero(remaining)[1].reshape(len(joints), -1)
        right = np.concatenate([parents, -mine[each, stay].transpose(0, 2, 1)], axis=2)
        solved = np.linalg.solve(mine[each, dropped].transpose(0, 2, 1), right)
        for k, joint in enumerate(joints.tolist()):
            shares[joint] = (dropped[k], stay[k], solved[k, :, :PER_LINK], solved[k, :, PER_LINK:])
    return [shares[joint] for joint in range(len(tree))]


def _handed_over(slides: bool, axis: Array, rotation: Array, origin: Array) -> tuple[Array, Array]:
    """Changes of a link that its joint cannot tell from changes of its parent, as (n, 10, k) and (n, k, 10).

    axis, origin: (n, 3); rotation: (n, 3, 3), of n joints that all slide or all turn.
    """
    count = len(axis)
    if slides:
        spreads = [np.broadcast_to(_symmetric(entry), (count, 3, 3)) for entry in INERTIA_ENTRIES]
        mine = np.stack([_parameters(0.0, np.zeros(3), spread) for spread in spreads], axis=2)
        turned = [rotation @ spread @ rotation.transpose(0, 2, 1) for spread in spreads]
        return mine, np.stack([_parameters(0.0, np.zeros(3), spread) for spread in turned], axis=1)
    spread = np.eye(3) - _outer(axis, axis)  # mass spread along the axis
    moment = np.einsum("nij,nj->ni", rotation, axis)
    nothing, none = np.zeros((count, 3)), np.zeros((count, 3, 3))
    along = np.einsum("ni,ni->n", origin, moment)[:, None, None]
    far = np.einsum("ni,ni->n", origin, origin)[:, None, None]
    changes = [
        _parameters(1.0, nothing, none),
        _parameters(0.0, axis, none),
        _parameters(0.0, nothing, spread),
    ]
    handed = [
        _parameters(1.0, origin, far * np.eye(3) - _outer(origin, origin)),
        _parameters(0.0, moment, 2 * along * np.eye(3) - _outer(origin, moment) - _outer(moment, origin)),
        _parameters(0.0, nothing, rotation @ spread @ rotation.transpose(0, 2, 1)),
    ]
    return np.stack(changes, axis=2), np.stack(handed, axis=1)


def _dropped(slides: bool, axis: Array) -> Indices:
    """Parameters of each link whose columns go: mass, first moment along the axis, one inertia across it."""
    count = len(axis)
    if slides:
        return np.tile(np.arange(4, PER_LINK), (count, 1))
    across = 1 - axis**2
    along = np.argmax(np.abs(axis), axis=1)
    largest = 2 - np.argmax((across > across.max(axis=1, keepdims=True) - 1e-9)[:, ::-1], axis=1)
    return np.column_stack([np.zeros(count, dtype=np.int64), 1 + along, np.array(DIAGONAL)[largest]])


def _without_hidden(equation: Equation, kept: list[int], expressed: Array) -> tuple[list[int], Array]:
    """Drop the columns that a fixed base hides: each that is a sum of columns nearer to the base."""
    structural = BaseParameters(equation.links, np.array(kept), np.zeros((0, 0)))
    samples = 2 * len(kept) // max(len(equation.tree), 1) + 20
    y = equation.regressor(_probing_motion(equation, samples), structural.masks)
    y = np.moveaxis(y, -1, 0).reshape(-1, len(kept))
    scale = np.linalg.norm(y, axis=0)
    present = scale > RANK_TOLERANCE * scale.max(initial=0.0)
    unit = y / np.where(present, scale, 1.0)
    independent: list[int] = []
    orthogonal = np.zeros((len(y), 0))
    for column in np.flatnonzero(present):
        rest = unit[:, column]
        for _ in range(2):  # once more, for what rounding left
            rest = rest - orthogonal @ (orthogonal.T @ rest)
        if np.linalg.norm(rest) > RANK_TOLERANCE:
            independent.append(int(column))
            orthogonal = np.column_stack([orthogonal, rest / np.linalg.norm(rest)])
    shares = np.linalg.lstsq(unit[:, independent], unit, rcond=None)[0]
    shares *= np.where(present, scale, 0.0) / scale[independent][:, None]
    chosen = [kept[column] for column in independent]
    combined = np.zeros_like(expressed)
    combined[:, chosen] = expressed[:, kept] @ shares.T
    return chosen, combined


def _probing_motion(equation: Equation, samples: int) -> Motion:
    """Pseudo-random states under the model's gravity; the sequence is fixed by NumPy's PCG64 and the seed."""
    random = np.random.Generator(np.random.PCG64(PROBING_SEED))
    joints = len(equation.tree)
    q, v, a = (2 * random.random((samples, joints)) - 1 for _ in range(3))
    return Motion(np.tile(equation.rest, (samples, 1)), 3 * q, v, a)


def _symmetric(entry: tuple[int, int]) -> Array:
    matrix = np.zeros((3, 3))
    matrix[entry] = matrix[entry[::-1]] = 1.0
    return matrix


def _outer(a: Array, b: Array) -> Array:
    return a[:, :, None] * b[:, None, :]


def _parameters(mass: float, moment: Array, inertia: Array) -> Array:
    """Mass, first moments (n, 3) and inertias (n, 3, 3) as (n, 10) in Pinocchio's order."""
    found = np.empty((len(inertia), PER_LINK))
    found[:, 0], found[:, 1:4], found[:, 4:] = mass, moment, inertia[:, _ROWS, _COLUMNS]
    return found

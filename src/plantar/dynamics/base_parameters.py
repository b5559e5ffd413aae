"""Which combinations of inertial parameters move the robot at all: the minimal (base) parameters.

Found from the structure of the tree alone. What a joint cannot tell apart from a change of its parent is
handed to the parent: behind a revolute joint the mass, the first moment along the axis and one moment of
inertia; behind a prismatic joint the whole inertia. For a floating base nothing else is lost. Joints near a
fixed base move too little for the rest: a first axis along gravity, parallel axes. Those columns are found by
the rank of eq. 1 over a fixed sequence of pseudo-random states, the same on every machine, never over a
recording.

A base parameter is one parameter of one link (a column of eq. 1 that is kept) plus the shares of those handed
to it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plantar.conventions import INERTIAL_NAMES, Array
from plantar.dynamics.equation import PER_LINK, Equation
from plantar.dynamics.motion import Motion

# (row, column) of the inertia matrix for each of its six parameters, in Pinocchio's order.
INERTIA_ENTRIES = ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))
_ROWS, _COLUMNS = np.array(INERTIA_ENTRIES).T
DIAGONAL = (4, 6, 9)  # Ixx, Iyy, Izz among the ten
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
    """The minimal parameters of a robot, from its structure alone; the same on every machine."""
    size = PER_LINK * len(equation.links)
    first_joint = 1 if equation.floating else 0
    kept: list[int] = []
    # expressed[k]: column k of eq. 1 as a sum of the kept columns, found from the root outwards.
    expressed = np.zeros((size, size))
    for link in range(len(equation.links)):
        own = range(PER_LINK * link, PER_LINK * (link + 1))
        if link < first_joint:
            kept += own
            expressed[own, own] = 1.0
            continue
        joint = link - first_joint
        mine, parents = _handed_over(equation, joint)
        dropped = _dropped(equation, joint)
        remaining = [p for p in range(PER_LINK) if p not in dropped]
        kept += [PER_LINK * link + p for p in remaining]
        expressed[[own[p] for p in remaining], [own[p] for p in remaining]] = 1.0
        # Y_link mine == Y_parent parents, solved for the dropped columns of Y_link.
        parent = equation.parent_link(link)
        shares = np.linalg.solve(mine[dropped].T, np.hstack([parents.T, -mine[remaining].T]))
        above = np.zeros((len(dropped), size))
        if parent >= 0:
            above = shares[:, :PER_LINK] @ expressed[PER_LINK * parent : PER_LINK * (parent + 1)]
        above[:, [own[p] for p in remaining]] = shares[:, PER_LINK:]
        expressed[[own[p] for p in dropped]] = above
    if not equation.floating:
        kept, expressed = _without_hidden(equation, kept, expressed)
    grouping = expressed[:, kept].T.copy()
    grouping[np.abs(grouping) < ROUNDING] = 0.0
    return BaseParameters(equation.links, np.array(kept, dtype=np.int64), grouping)


def _handed_over(equation: Equation, joint: int) -> tuple[Array, Array]:
    """Changes of a link that its joint cannot tell from changes of its parent: columns of two (10, k)."""
    tree = equation.tree
    axis, rotation, origin = tree.axes[joint], tree.rotations[joint], tree.translations[joint]
    mine, parents = [], []
    if tree.slides[joint]:
        spreads = [_symmetric(entry) for entry in INERTIA_ENTRIES]
    else:
        spreads = [np.eye(3) - np.outer(axis, axis)]  # mass spread along the axis
        mine.append(_parameters(1.0, np.zeros(3), np.zeros((3, 3))))
        parents.append(_parameters(1.0, origin, (origin @ origin) * np.eye(3) - np.outer(origin, origin)))
        mine.append(_parameters(0.0, axis, np.zeros((3, 3))))
        moment = rotation @ axis
        shifted = 2 * (origin @ moment) * np.eye(3) - np.outer(origin, moment) - np.outer(moment, origin)
        parents.append(_parameters(0.0, moment, shifted))
    for spread in spreads:
        mine.append(_parameters(0.0, np.zeros(3), spread))
        parents.append(_parameters(0.0, np.zeros(3), rotation @ spread @ rotation.T))
    return np.column_stack(mine), np.column_stack(parents)


def _dropped(equation: Equation, joint: int) -> list[int]:
    """Parameters of a link whose columns go: mass, first moment along the axis, one inertia across it."""
    if equation.tree.slides[joint]:
        return list(range(4, PER_LINK))
    across = 1 - equation.tree.axes[joint] ** 2
    along = int(np.argmax(np.abs(equation.tree.axes[joint])))
    largest = max(k for k in range(3) if across[k] > across.max() - 1e-9)
    return [0, 1 + along, DIAGONAL[largest]]


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


def _parameters(mass: float, moment: Array, inertia: Array) -> Array:
    """Mass, first moment and inertia as ten numbers in Pinocchio's order."""
    return np.array([mass, *moment, *inertia[_ROWS, _COLUMNS]])

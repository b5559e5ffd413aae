"""What a result of eq. 2 or 3 says in text: masses of the links, terms of the joints, prediction."""

from __future__ import annotations

from collections.abc import Sequence

from plantar.results.dynamics_rows import DynamicsScore, InertialParameter, JointParameter
from plantar.results.numbers import number, percent, unit, with_uncertainty

LINK_HEADS = ("link", "mass [kg]", "URDF", "m·c [kg·m]", "URDF")
JOINT_HEADS = ("joint", "parameter", "value", "unit", "±", "verdict")
SCORE_HEADS = ("motions", "of", "unit", "rms error", "rms by URDF")
KINDS = {"direct": "fitted", "cross": "unseen"}


def link_cells(rows: Sequence[InertialParameter]) -> list[tuple[str, ...]]:
    """Mass and first moment of each link, beside the URDF's."""
    links: dict[str, dict[str, InertialParameter]] = {}
    for row in rows:
        links.setdefault(row.link, {})[row.name] = row
    cells: list[tuple[str, ...]] = []
    for link, named in links.items():
        moment = [named[name] for name in ("mx", "my", "mz")]
        cells.append((
            link, number(named["m"].value), number(named["m"].cad),
            " ".join(number(row.value, 3) for row in moment), " ".join(number(row.cad, 3) for row in moment),
        ))  # fmt: skip
    return cells


def joint_cells(rows: Sequence[JointParameter]) -> list[tuple[str, ...]]:
    """Each joint's terms: value ± half width of the 95 % interval, unit, the half width in percent, verdict."""
    cells: list[tuple[str, ...]] = []
    for row in rows:
        half = (row.interval95[1] - row.interval95[0]) / 2
        width = percent(100 * half / abs(row.value)) if row.value else ""
        value = with_uncertainty(row.value, half)
        cells.append((row.joint, row.name, value, unit(row.unit), width, row.verdict))
    return cells


def score_cells(rows: Sequence[DynamicsScore]) -> list[tuple[str, ...]]:
    """Of each axis or joint the rms error over all motions, beside that of the URDF alone."""
    groups: dict[tuple[str, str, str], list[DynamicsScore]] = {}
    for row in rows:
        groups.setdefault((row.kind, row.axis or row.joint or "", row.unit), []).append(row)
    return [
        (
            f"{len(group)} {KINDS[kind]}",
            place,
            unit(name),
            number(_rms([row.rms_error for row in group], group), 3),
            number(_rms([row.cad_rms_error for row in group], group), 3),
        )
        for (kind, place, name), group in groups.items()
    ]


def _rms(errors: Sequence[float], group: Sequence[DynamicsScore]) -> float:
    """Root mean square over the samples of all motions."""
    samples = [row.samples for row in group]
    total = sum(error**2 * count for error, count in zip(errors, samples, strict=True))
    return float((total / max(sum(samples), 1)) ** 0.5)

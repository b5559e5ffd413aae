"""An inertia or joints result on the terminal: parameters, validation, notes."""

from __future__ import annotations

from rich.console import Console

from plantar.cli.console.terminal import VERDICT_STYLE, print_notes, table
from plantar.results.dynamics import ONE_OF_MANY, DynamicsResult
from plantar.results.numbers import number

# Of the largest number of a unit: rounding leaves as much of what is zero, and no sensor shows it.
DUST = 1e-9
LINK_COLUMNS = ("m", "mx", "my", "mz")


def print_inertia(out: Console, result: DynamicsResult) -> None:
    """Masses and first moments by link, beside the URDF's; validation; notes."""
    found: dict[str, dict[str, tuple[float, float]]] = {}
    for row in result.inertial_parameters:
        found.setdefault(row.link, {})[row.name] = (row.value, row.cad)
    cells = [
        (link, *(f"{number(values[name][0])} ({number(values[name][1])})" for name in LINK_COLUMNS))
        for link, values in found.items()
    ]
    columns = ("link", "mass [kg] (URDF)", "m·cx [kg.m]", "m·cy [kg.m]", "m·cz [kg.m]")
    out.print(table(f"Inertial parameters of {result.robot}: {result.mass:.2f} kg", columns, cells))
    out.print(ONE_OF_MANY)
    _print_rest(out, result)


def print_joints(out: Console, result: DynamicsResult) -> None:
    """Every joint's terms with intervals and verdicts; validation; notes."""
    largest: dict[str, float] = {}
    for row in result.parameters:
        largest[row.unit] = max(largest.get(row.unit, 0.0), abs(row.value))

    def shown(value: float, of: str) -> str:
        return number(0.0 if abs(value) < DUST * largest[of] else value)

    cells = [
        (row.joint, row.name, shown(row.value, row.unit), row.unit,
         " to ".join(shown(end, row.unit) for end in row.interval95), row.verdict, row.reason)
        for row in result.parameters
    ]  # fmt: skip
    columns = ("joint", "parameter", "value", "unit", "95 % interval", "verdict", "reason")
    styles = [VERDICT_STYLE[row.verdict] for row in result.parameters]
    out.print(table(f"Joint parameters of {result.robot}", columns, cells, styles))
    _print_rest(out, result)


def _print_rest(out: Console, result: DynamicsResult) -> None:
    for kind, title in (("direct", "Direct validation"), ("cross", "Cross validation")):
        rows = [row for row in result.validation if row.kind == kind]
        if not rows:
            continue
        cells = [
            (row.motion, row.axis or row.joint or "", row.unit, number(row.rms_error, 3), number(row.cad_rms_error, 3),
             number(row.mean_abs_error, 3), number(row.zero_mean_abs, 3), number(row.relative_error_percent, 3))
            for row in rows
        ]  # fmt: skip
        columns = ("motion", "of", "unit", "rms", "rms by URDF", "mean |error|", "mean alone", "error %")
        out.print()
        out.print(table(title, columns, cells))
    print_notes(out, result.notes)

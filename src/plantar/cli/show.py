"""`plantar show reference`."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

from typer import Argument

from plantar.cli.console import options
from plantar.cli.console.terminal import console, print_json, table
from plantar.results.feet import FeetResult
from plantar.results.numbers import number
from plantar.results.reference import neighbours


def run(
    result: Annotated[
        Path | None, Argument(help="A result of `identify feet` to place.", metavar="RESULT.json")
    ] = None,
    json: options.Json = False,
) -> None:
    """Foot stiffness that others published or configured, softest first, and your own among it.

    Example: plantar show reference out/feet/result.json
    """
    lines = neighbours(() if result is None else FeetResult.load(result, residuals=False).parameters)
    if json:
        rows = [asdict(line.reference) | {"own": line.own} for line in lines]
        print_json(schema="plantar.reference/1", references=rows)
        return
    heads = ("robot", "pitch [N·m/rad]", "roll [N·m/rad]", "z [N/m]", "C [N·m·s/rad]", "", "source")
    cells = [
        (one.robot, number(one.pitch), number(one.roll), number(one.z), number(one.damping, 3), one.origin, one.source)
        for one in (line.reference for line in lines)
    ]  # fmt: skip
    styles = ["bold" if line.own else "" for line in lines]
    console().print(table("Foot stiffness elsewhere", heads, cells, styles))

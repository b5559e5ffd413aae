"""`plantar diagnose`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.markup import escape

from plantar.cli.terminal import VERDICT_STYLE, console, number, table
from plantar.results.feet import FEET_SCHEMA
from plantar.results.io import dump_json, read_result
from plantar.results.usage import used_shares


def run(
    result: Annotated[Path, typer.Argument(help="The result of `identify feet`.", metavar="RESULT.json")],
    json: Annotated[bool, typer.Option("--json", help="Print JSON instead of tables.")] = False,
) -> None:
    """What limits each number of a result, and which recording would make it tighter.

    Example: plantar diagnose out/feet/result.json
    """
    content = read_result(result, FEET_SCHEMA)
    diagnosis, used = content.get("diagnosis", []), used_shares(content["phases"])
    if json:
        print(dump_json({"schema": "plantar.diagnosis/1", "diagnosis": diagnosis, "served": used}), end="")
        return
    screen = console()
    verdicts = {(p["foot"], p["axis"], p["name"]): p["verdict"] for p in content["parameters"]}
    rows = [
        (d["foot"], d["axis"], d["name"], number(d["half_width_percent"], 2), d["limit"],
         ", ".join(f"{cause} {100 * share:.0f} %" for cause, share in d["variance_shares"].items() if share > 0.005))
        for d in diagnosis
    ]  # fmt: skip
    styles = [VERDICT_STYLE[verdicts[d["foot"], d["axis"], d["name"]]] for d in diagnosis]
    heads = ("foot", "axis", "parameter", "± % (95 %)", "limited by", "share of the variance")
    screen.print(table("What limits each number", heads, rows, styles))
    for row in content["parameters"]:
        if row["verdict"] != "usable":
            advice = f" Next: {row['advice']}." if row.get("advice") else ""
            line = f"{row['foot']} {row['axis']} {row['name']} is {row['verdict']}: {row['reason']}.{advice}"
            screen.print(escape(line))
    for limit in dict.fromkeys(d["limit"] for d in diagnosis):
        remedy = next(d["text"].rsplit("To tighten: ", 1)[-1] for d in diagnosis if d["limit"] == limit)
        screen.print(escape(f"Against {limit}: {remedy}."))
    cells = [
        (s["motion"], s["foot"], f"{s['seconds']:.1f}", f"{s['served']:.1f}", s["reasons"]) for s in used
    ]
    screen.print(
        table("\nWhat served of each log", ("motion", "foot", "seconds", "served", "left out because"), cells)
    )

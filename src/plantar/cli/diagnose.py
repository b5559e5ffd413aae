"""`plantar diagnose`."""

from __future__ import annotations

from dataclasses import asdict

from rich.markup import escape

from plantar.cli.console import options
from plantar.cli.console.terminal import VERDICT_STYLE, console, print_json, table
from plantar.cli.identify.feet_tables import print_advice
from plantar.errors import PlantarError
from plantar.results.feet import FeetResult
from plantar.results.feet_text import ASSUMPTION_HEADS, assumption_cells
from plantar.results.numbers import number
from plantar.results.usage import used_shares


def run(result: options.FeetFile, json: options.Json = False) -> None:
    """What limits each number of a result, and which recording would make it tighter.

    Example: plantar diagnose out/feet/result.json
    """
    found = FeetResult.load(result, residuals=False)
    diagnosis, used = found.diagnosis, used_shares(found.phases)
    if json:
        rows, allowed_for = ([asdict(row) for row in part] for part in (diagnosis, found.assumptions))
        served = [share.to_dict() for share in used]
        print_json(schema="plantar.diagnosis/1", diagnosis=rows, assumptions=allowed_for, served=served)
        return
    screen = console()
    verdicts = {(row.foot, row.axis, row.name): row.verdict for row in found.parameters}
    for row in diagnosis:
        if (row.foot, row.axis, row.name) not in verdicts:
            message = f"diagnosis of {row.foot} {row.axis} {row.name}, which is no parameter of the result"
            raise PlantarError(message, path=result, valid="a result.json as `identify feet` writes it")
    cells = [
        (row.foot, row.axis, row.name, number(row.half_width_percent, 2), row.limit,
         ", ".join(f"{cause} {100 * share:.0f} %" for cause, share in row.variance_shares.items() if share > 0.005))
        for row in diagnosis
    ]  # fmt: skip
    styles = [VERDICT_STYLE[verdicts[row.foot, row.axis, row.name]] for row in diagnosis]
    heads = ("foot", "axis", "parameter", "± % (95 %)", "limited by", "share of the variance")
    screen.print(table("What limits each number", heads, cells, styles))
    print_advice(screen, found.parameters)
    told = {row.advice for row in found.parameters}
    for limit, advice in {
        row.limit: row.advice for row in diagnosis if row.advice and row.advice not in told
    }.items():
        screen.print(escape(f"Against {limit}: {advice}."))
    if allowed := assumption_cells(found.assumptions):
        screen.print(table("\nWhat the robot file may be wrong about", ASSUMPTION_HEADS, allowed))
    shares = [(one.motion, one.foot, f"{one.seconds:.1f}", f"{one.used:.1f}", one.reasons) for one in used]
    columns = ("motion", "foot", "seconds", "used", "left out because")
    screen.print(table("\nHow much of each log was used", columns, shares))

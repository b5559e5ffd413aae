"""`plantar fleet report`."""

from __future__ import annotations

import json as json_format
from typing import Annotated, Any, Final

from rich.markup import escape
from typer import Argument, Option

from plantar.cli.console.terminal import SCREENFUL, console, print_json
from plantar.fleet.places import Store
from plantar.fleet.summary import FALSE_ALARMS, FleetSummary, summary_of
from plantar.fleet.tables import read_failures, read_groups, read_results
from plantar.report.fleet import fleet_page
from plantar.results.io import dump_json

PAGE: Final = "fleet.html"
SUMMARY: Final = "fleet.json"
RUN_FILE: Final = "run.json"
RUN_SCHEMA: Final = "plantar.fleet.run/1"
RATE_HELP = "False alarms to accept, per robot and year."


def run(
    folder: Annotated[str, Argument(help="The --out of `plantar fleet run`.", metavar="DIR")],
    false_alarms: Annotated[float, Option(metavar="N", help=RATE_HELP)] = FALSE_ALARMS,
    json: Annotated[bool, Option("--json", help="Print fleet.json instead of the page's path.")] = False,
    quiet: Annotated[bool, Option("--quiet", "-q", help="Print nothing.")] = False,
) -> None:
    """A fleet's results together: fleet.html with alarms, robots over time and failures; fleet.json for scripts.

    Example: plantar fleet report out/fleet --false-alarms 0.5
    """
    store = Store(folder)
    summary = write_report(store, false_alarms)
    if json:
        print_json(**summary.to_dict())
    elif not quiet:
        print_summary(summary)
        print(store.path(PAGE))


def write_report(store: Store, false_alarms: float = FALSE_ALARMS) -> FleetSummary:
    """`fleet.json`, then `fleet.html`, from the tables of a store."""
    summary = summary_of(read_results(store), read_failures(store), false_alarms)
    store.write(SUMMARY, dump_json(summary.to_dict()).encode())
    store.write(PAGE, fleet_page(summary, read_groups(store), _last_run(store)).encode())
    return summary


def print_summary(summary: FleetSummary) -> None:
    """Alarms, the latest first, then kinds of failures with one of each: at most SCREENFUL lines of either."""
    screen = console()
    for alarm in summary.alarms[:SCREENFUL]:
        style = "dim" if alarm.kind == "outlier" else "yellow"
        screen.print(f"[{style}]{alarm.kind}: {escape(alarm.text)}[/]")
    if len(summary.alarms) > SCREENFUL:
        screen.print(f"[dim]and {len(summary.alarms) - SCREENFUL} more alarms: see {PAGE}[/]")
    for reason in summary.failures[:SCREENFUL]:
        screen.print(f"[red]failed[/], {reason.count} like this: {escape(reason.example)}")


def _last_run(store: Store) -> dict[str, Any]:
    """What the last run counted; nothing where its file is not there, or not such a one."""
    try:
        found = json_format.loads(store.read(RUN_FILE) or b"{}")
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}

"""The command line: one file a verb, each imported only when it is called."""

from __future__ import annotations

import atexit
import gc
import os
import sys
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperArgument, TyperCommand, TyperGroup

from plantar import __version__
from plantar.errors import PlantarError

# verb -> (module of this package, one line of help), in the order in which they are listed; the module has `run`.
COMMANDS = {
    "demo": ("demo", "Everything on a simulated robot whose feet are known: tables, figures, report."),
    "init": ("init", "A first robot file from a URDF and, if given, logs; every guess is marked."),
    "inspect": ("inspect", "What is in the logs, what is wrong with them, what they can identify."),
    "identify feet": ("identify.feet", "Stiffness, damping and offset of each foot."),
    "identify inertia": ("identify.inertia", "Inertial parameters without joint torques."),
    "identify joints": ("identify.joints", "Friction, springs and offsets of the joints."),
    "validate": ("validate", "Score a result on logs that it has not seen."),
    "diagnose": ("diagnose", "What limits each number of a result, and what to record next."),
    "report": ("report", "Write the result's report.html again."),
    "export": ("export", "Write a result in the format of a simulator or controller."),
    "compare": ("compare", "Play logs in MuJoCo on rigid and on exported feet, beside the record."),
    "online": ("online", "Replay a log through the estimator of controllers, sample by sample."),
    "design": ("design", "A motion that identifies the feet well, within balance and limits."),
    "select": ("select", "Which of these logs are most informative about each parameter."),
    "simulate": ("simulate", "Logs from a simulated robot, with the imperfections that you choose."),
    "convert": ("convert", "A log in another format."),
    "fleet plan": ("fleet.plan", "A manifest from files: a group for each robot and day."),
    "fleet run": ("fleet.run", "Identify the feet of every group of a manifest, on a Dask cluster."),
    "fleet inertia": ("fleet.inertia", "Inertial parameters from all logs of a manifest (eq. 2)."),
    "fleet report": ("fleet.report", "Alarms, robots over time and failures of a fleet, on one page."),
    "show reference": ("show", "Foot stiffness that others published or configured, and yours among it."),
    "bug-report": ("bug_report", "What to send with a question: versions, settings, what inspect says."),
}
EXAMPLE = "plantar identify feet robot.yaml sway_*.csv --validate squat.csv --out out/feet"
SEVERAL = "--validate"  # takes one log or more
GROUPS = {  # what stands first in their help, and last
    "identify": ("Identify feet, inertial parameters or joints from logs.", EXAMPLE),
    "show": ("Published values to compare with.", "plantar show reference out/feet/result.json"),
    "fleet": (
        "Many logs of many robots: plan, run, report.",
        "plantar fleet plan 'logs/*.mcap' --robot robot.yaml --out fleet.csv, then "
        "plantar fleet run fleet.csv --out out/fleet",
    ),
}

GARBAGE = 200_000  # new objects after which the collector walks over all: twice what modules and a result are


def main(arguments: list[str] | None = None) -> None:
    """Run one command. Exits 0 when done, 1 on a known error (one line on stderr), 2 on wrong usage."""
    # Logs and feet fill the cores already; a BLAS with threads of its own only waits for them.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # Arrow's own pool keeps what it has freed, beside what NumPy keeps: a tenth of all memory.
    os.environ.setdefault("ARROW_DEFAULT_MEMORY_POOL", "system")
    # Arrays are freed without the collector, which would walk over every module again and again.
    gc.set_threshold(GARBAGE)
    atexit.register(gc.freeze)  # nor does it have to walk over them before they end with the process
    arguments = _spread(sys.argv[1:] if arguments is None else arguments)
    try:
        _application(arguments)(args=arguments, prog_name="plantar")
    except PlantarError as error:
        _fail(f"plantar: {error}")
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(1)
    except OSError as error:  # a disk that is full, a folder that is not ours, a name that is too long
        _fail(f"plantar: {error.filename or 'the system says'}: {error.strerror or error}")
    except KeyboardInterrupt:
        _fail("plantar: interrupted", 130)
    except MemoryError:
        _fail("plantar: not enough memory for these logs (valid: fewer or shorter logs at a time)")


def _application(arguments: list[str]) -> typer.Typer:
    """The tree of commands, with only the one that is called imported."""
    application = _group(
        "What does your legged robot stand on? Foot stiffness, damping and offset from its own logs.", EXAMPLE
    )
    application.callback()(_root)
    groups = {name: _group(*texts) for name, texts in GROUPS.items()}
    called = _called(arguments)
    for verb, (module, text) in COMMANDS.items():
        *group, name = verb.split()
        holder = groups[group[0]] if group else application
        command = import_module(f"plantar.cli.{module}").run if verb == called else _not_called
        holder.command(name, cls=_Command, help=None if verb == called else text, short_help=text)(command)
    for name, group_application in groups.items():
        application.add_typer(group_application, name=name)
    return application


def _spread(arguments: list[str]) -> list[str]:
    """`--validate A B` as `--validate A --validate B`: the option takes every log up to the next option."""
    spread: list[str] = []
    taking = False
    for argument in arguments:
        if argument.startswith("-"):
            taking = argument == SEVERAL
        elif taking and spread[-1] != SEVERAL:
            spread.append(SEVERAL)
        spread.append(argument)
    return spread


def _called(arguments: list[str]) -> str:
    """The verb in the arguments, of one or two words; options of the root come before it."""
    words = [word for word in arguments if not word.startswith("-")]
    return " ".join(words[:2]) if words and words[0] in GROUPS else words[0] if words else ""


class _Command(TyperCommand):
    """Arguments as manuals write them: no braces around what is required, no types, which their help tells."""

    def invoke(self, ctx: Any) -> Any:
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:  # typer would end without a word
            _fail("plantar: interrupted", 130)

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        return ["[OPTIONS]", *(_written(one) for one in self.params if isinstance(one, TyperArgument))]

    def format_options(self, ctx: Any, formatter: Any) -> None:
        sections: dict[str, list[tuple[str, str]]] = {"Arguments": [], "Options": []}
        for one in self.get_params(ctx):
            if told := one.get_help_record(ctx):
                named = isinstance(one, TyperArgument)
                sections["Arguments" if named else "Options"].append(
                    (str(one.metavar), told[1]) if named else told
                )
        for title, rows in sections.items():
            if rows:
                with formatter.section(title):
                    formatter.write_dl(rows)


def _written(one: TyperArgument) -> str:
    return str(one.metavar) if one.required else f"[{one.metavar}]"


class _Listed(TyperGroup):
    """Commands and groups of commands in the order of COMMANDS: a user's first steps come first."""

    def list_commands(self, ctx: Any) -> list[str]:
        if ctx.parent is not None:
            return list(self.commands)
        return list(dict.fromkeys(verb.split()[0] for verb in COMMANDS))


def _group(text: str, example: str) -> typer.Typer:
    return typer.Typer(
        cls=_Listed,
        help=text,
        epilog=f"Example: {example}",
        no_args_is_help=True,
        add_completion=False,
        rich_markup_mode=None,  # boxes around the help take a quarter of a second
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )


def _print_version(asked: bool) -> None:
    if asked:
        print(__version__)
        raise typer.Exit


def _root(
    version: bool = typer.Option(
        False, "--version", callback=_print_version, help="Print the version and exit."
    ),
) -> None:
    """Options that stand before the command."""


def _not_called() -> None:
    """Stands for a command whose module is not needed now."""


def _fail(line: str, code: int = 1) -> None:
    print(line, file=sys.stderr)
    sys.exit(code)

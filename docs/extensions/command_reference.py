"""The reference of the command line, read from the functions that the commands are: the directive `commands`."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib import import_module
from typing import Any, Literal, get_args, get_origin, get_type_hints

import typer

from plantar.cli import COMMANDS


@dataclass(frozen=True)
class Parameter:
    """An argument or an option of a command, and what the help says of it."""

    names: tuple[str, ...]
    option: bool
    help: str
    needed: bool
    default: Any
    choices: tuple[str, ...]
    value: str

    @property
    def meaning(self) -> str:
        """What it does, what it may be, and what holds where it is left out."""
        text = self.help
        if self.choices:
            text += " One of " + ", ".join(f"`{choice}`" for choice in self.choices) + "."
        if self.needed:
            return f"{text} Needed."
        unsaid = self.default is None or self.default is False or self.default == ""
        return text if unsaid else f"{text} Default: `{self.default}`."

    @property
    def usage(self) -> str:
        return f"{self.names[0]} {self.value}" if self.option else self.names[0]


def parameters(verb: str) -> list[Parameter]:
    """What a command takes, in its order."""
    run = import_module(f"plantar.cli.{COMMANDS[verb][0]}").run
    hints = get_type_hints(run, include_extras=True)
    return [parameter(one, hints[one.name]) for one in inspect.signature(run).parameters.values()]


def parameter(one: inspect.Parameter, hint: Any) -> Parameter:
    plain, info = annotated(hint)
    option = isinstance(info, typer.models.OptionInfo)
    needed = one.default is inspect.Parameter.empty
    upper = info.metavar or one.name.upper()
    if option:
        # Inside Annotated, typer keeps the first name that is given in the place of the default.
        first = [info.default] if isinstance(info.default, str) else []
        names = (*first, *(info.param_decls or ())) or (f"--{one.name.replace('_', '-')}",)
    else:
        names = (upper if needed or upper.startswith("[") else f"[{upper}]",)
    choices = get_args(plain) if get_origin(plain) is Literal else ()
    default = None if needed else one.default
    return Parameter(names, option, info.help or "", needed, default, choices, upper)


def annotated(hint: Any) -> tuple[Any, Any]:
    """The type behind `Annotated[...]` and what typer knows of it, also where it may be None."""
    for part in (hint, *get_args(hint)):
        known = [one for one in getattr(part, "__metadata__", ()) if hasattr(one, "param_decls")]
        if known:
            return get_args(part)[0], known[0]
    raise TypeError(f"{hint} says nothing to typer")


def reference() -> str:
    """Every command as Markdown: usage, what it does, its arguments, its options with their defaults."""
    return "\n\n".join(section(verb) for verb in COMMANDS)


def section(verb: str) -> str:
    """One command."""
    run = import_module(f"plantar.cli.{COMMANDS[verb][0]}").run
    taken = parameters(verb)
    arguments = [one for one in taken if not one.option]
    options = [one for one in taken if one.option]
    needed = [one.usage for one in [*arguments, *(one for one in options if one.needed)]]
    rest = ["[OPTIONS]"] if any(not one.needed for one in options) else []
    usage = " ".join(["plantar", verb, *needed, *rest])
    parts = [f"## plantar {verb}", f"```text\n{usage}\n```", *described(inspect.getdoc(run) or "")]
    parts += [table(kind, some) for kind, some in (("argument", arguments), ("option", options)) if some]
    return "\n\n".join(parts)


def described(text: str) -> Iterator[str]:
    """The paragraphs of a help text; its example as code."""
    for paragraph in text.split("\n\n"):
        _, example, command = paragraph.replace("\n", " ").partition("Example: ")
        yield f"```text\n{command}\n```" if example else paragraph


def table(head: str, rows: Iterable[Parameter]) -> str:
    lines = [
        f"| {', '.join(f'`{name}`' for name in row.names)} | {row.meaning.replace('|', chr(92) + '|')} |"
        for row in rows
    ]
    return "\n".join([f"| {head} | meaning |", "|---|---|", *lines])


def setup(app: Any) -> dict[str, Any]:
    """Make the directive known to Sphinx."""
    from sphinx.util.docutils import SphinxDirective

    class Commands(SphinxDirective):
        """` ```{commands} ` in a page: the whole reference in its place."""

        def run(self) -> list[Any]:
            return list(self.parse_text_to_nodes(reference(), allow_section_headings=True))

    app.add_directive("commands", Commands)
    return {"parallel_read_safe": True}

"""The option `--wrench-delay`, in ms in every command; libraries and files count in s."""

from __future__ import annotations

from typing import Annotated

import typer

LEAST = 0.1  # ms: less cannot be told from none, and is what seconds look like
HELP = (
    "How late the force sensors are against the IMU, in milliseconds (5, not 0.005). If left out: that of the "
    "result given with --result, where a command takes one, else estimated from the logs."
)


def seconds(text: str) -> float:
    """Milliseconds as typed -> s. Raises typer.BadParameter for no number, and for what can only be seconds."""
    try:
        value = float(text)
    except ValueError:
        raise typer.BadParameter(
            f"'{text}' is not a number of milliseconds (valid: 5, 7.5, -2, ...)"
        ) from None
    if 0 < abs(value) < LEAST:
        told = f"{value:g} ms is no delay that a log could show; the unit is ms"
        raise typer.BadParameter(f"{told} (valid: {1e3 * value:g} for {value:g} s; 0; {LEAST:g} or more)")
    return 1e-3 * value


WrenchDelay = Annotated[float | None, typer.Option("--wrench-delay", parser=seconds, metavar="MS", help=HELP)]

"""Arguments and options that several commands take, and what is typed there as the numbers that plantar works with."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Annotated

from typer import Argument, BadParameter, Option

from plantar.feet.settings import AUTOMATIC, MODEL_CHOICES, OffsetRule

SIZES = {"": 1, "K": 10**3, "M": 10**6, "G": 10**9, "T": 10**12}
SIZE = re.compile(r"(\d+(?:\.\d*)?)\s*([KMGT]?)B?", re.IGNORECASE)
LEAST_DELAY = 0.1  # ms: less cannot be told from none, and is what seconds look like

MEMORY_HELP = (
    "Memory that the logs' numbers may take, such as 500MB or 8GB. If left out: a quarter of this machine's memory. "
    "Logs that need more are refused before they are read."
)
DELAY_HELP = (
    "How late the force sensors are against the IMU, in milliseconds (5, not 0.005). If left out, it is estimated from "
    "the logs."
)
MODEL_HELP = (
    f"Model of the bush: {', '.join(MODEL_CHOICES)}. "
    f"{AUTOMATIC} takes the one that predicts held-out motions best."
)
SWING_HELP = (
    "Where the rubber has hysteresis and the target has none: the spring and damper of motions with this amplitude "
    "are written, in rad. If left out: the median amplitude of the identified motions."
)
PIVOT_HELP = (
    "mujoco-contact: what feet turn about: 'ground', or 'bush', the bush centre, as the robot's feet do. "
    "With 'bush' the robot stands lower, its soles in the ground."
)
LEAST_LOAD_HELP = (
    "mujoco-contact: share of the robot's weight below which a foot is soft along z. A smaller share suits feet that "
    "are lightly loaded, but K then holds up to a smaller angle only."
)


def size_in_bytes(text: str) -> int:
    """A size as people write it, in bytes. Raises typer.BadParameter."""
    found = SIZE.fullmatch(text.strip())
    size = int(float(found[1]) * SIZES[found[2].upper()]) if found else 0
    if size < 1:
        raise BadParameter(f"'{text}' is not a size (valid: 500MB, 8GB, ...)")
    return size


def seconds(text: str) -> float:
    """Milliseconds as typed -> s. Raises typer.BadParameter for no number, and for what can only be seconds."""
    try:
        value = float(text)
    except ValueError:
        raise BadParameter(f"'{text}' is not a number of milliseconds (valid: 5, 7.5, -2, ...)") from None
    if 0 < abs(value) < LEAST_DELAY:
        told = f"{value:g} ms is no delay that a log could show; the unit is ms"
        valid = f"{1e3 * value:g} for {value:g} s; 0; {LEAST_DELAY:g} or more"
        raise BadParameter(f"{told} (valid: {valid})")
    return 1e-3 * value


def bush_model(text: str) -> str:
    """The name of a bush model, or `auto`. Raises typer.BadParameter."""
    if text not in MODEL_CHOICES:
        raise BadParameter(f"'{text}' is not one of {', '.join(MODEL_CHOICES)}")
    return text


Robot = Annotated[Path, Argument(help="Robot file (YAML).", metavar="ROBOT.yaml")]
FeetFile = Annotated[Path, Argument(help="The result of `identify feet`.", metavar="RESULT.json")]
Logs = Annotated[list[Path], Argument(help="Logs to fit.", metavar="LOG...")]
Validate = Annotated[
    list[Path] | None,
    Option(
        "--validate",
        metavar="LOG...",
        help="One log or more that are not fitted: predicted and scored only (table 3).",
    ),
]
Out = Annotated[
    Path, Option("--out", metavar="DIR", help="Folder for result.json, the residuals and the report.")
]
Memory = Annotated[int | None, Option("--memory", parser=size_in_bytes, metavar="SIZE", help=MEMORY_HELP)]
WrenchDelay = Annotated[float | None, Option("--wrench-delay", parser=seconds, metavar="MS", help=DELAY_HELP)]
Offset = Annotated[OffsetRule, Option(help="One offset per motion, or shared by all as in the paper.")]
Model = Annotated[str, Option(parser=bush_model, help=MODEL_HELP, metavar="MODEL")]
Cutoff = Annotated[
    float,
    Option(
        metavar="HZ", help="Cut-off of the zero-phase low-pass filter on motion and forces, in Hz.", min=0.1
    ),
]
AsRecorded = Annotated[
    bool,
    Option(
        "--as-recorded", help="Report wrench channels that contradict Newton's law, but do not correct them."
    ),
]
Swing = Annotated[float | None, Option("--swing", help=SWING_HELP, metavar="RAD")]
Pivot = Annotated[str, Option("--pivot", help=PIVOT_HELP, metavar="PIVOT")]
LeastLoad = Annotated[float, Option("--least-load", help=LEAST_LOAD_HELP, metavar="SHARE")]
Json = Annotated[bool, Option("--json", help="Print JSON instead of tables.")]
Quiet = Annotated[bool, Option("--quiet", "-q", help="No tables, no progress.")]

"""What the verbs of `plantar identify` share: the way from files to a result that is kept and shown."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from plantar.cli.console.terminal import console, end_progress, print_json, progress
from plantar.files import refuse_file
from plantar.logs.freed_memory import keep_freed, return_freed
from plantar.logs.inputs import open_together, robot_of
from plantar.logs.motion_log import MotionLog

if TYPE_CHECKING:
    from rich.console import Console

    from plantar.robot.model import RobotModel


class Result(Protocol):
    """What any identification gives."""

    def to_dict(self) -> dict[str, Any]: ...

    def save(self, directory: Path) -> Path: ...


Found = TypeVar("Found", bound=Result)


def opened(
    robot: Path, logs: Sequence[Path], validate: Sequence[Path] | None, out: Path, memory: int | None
) -> tuple[RobotModel, list[MotionLog], list[MotionLog]]:
    """The robot, the logs to fit and those to score; an `out` that cannot be used is refused before any work."""
    refuse_file(out)
    keep_freed()
    known = robot_of(robot)
    opened = open_together([*logs, *(validate or ())], known, memory)
    return known, opened[: len(logs)], opened[len(logs) :]


def keep(
    result: Found,
    out: Path,
    report: Callable[[Path], Path],
    show: Callable[[Console, Found], None],
    *,
    json: bool,
    quiet: bool,
    beside: Sequence[str] = (),
) -> None:
    """Save, report, print; `beside`: names of files worth naming that the result saves beside result.json."""
    progress(quiet)("write")
    return_freed()
    path = result.save(out)
    written = [path, *(out / name for name in beside), report(path)]
    end_progress(quiet)
    if json:
        print_json(**result.to_dict())
    elif not quiet:
        screen = console()
        show(screen, result)
        screen.print("\n" + "\n".join(str(file) for file in written), markup=False)

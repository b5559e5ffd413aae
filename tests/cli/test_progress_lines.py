"""What is shown of long work on stderr: on a terminal, elsewhere, and where nothing was asked for."""

from __future__ import annotations

import pytest

from plantar.cli.console.terminal import end_progress, progress
from plantar.cli.demo import _progress

CLEARED = "\r\033[K"
STEPS = ("plan", "play Squat", "fit left", "replay Squat", "write")


@pytest.mark.parametrize("terminal", [True, False])
def test_a_terminal_shows_a_step_in_place_of_the_last_one(
    terminal: bool, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: terminal)
    show = progress(quiet=False)
    show("read")
    show("fit")
    end_progress(quiet=False)
    steps = f"{CLEARED}  read{CLEARED}  fit{CLEARED}"
    assert capsys.readouterr().err == (steps if terminal else "  read\n  fit\n")


@pytest.mark.parametrize(
    ("terminal", "shown"), [(True, STEPS), (False, ("play Squat", "replay Squat", "write"))]
)
def test_the_demo_shows_every_step_on_a_terminal_and_elsewhere_what_takes_long(
    terminal: bool,
    shown: tuple[str, ...],
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: terminal)
    show = _progress(quiet=False)
    for step in STEPS:
        show(step)
    lines = capsys.readouterr().err.replace(CLEARED, "\n").split("\n")
    assert tuple(line.strip() for line in lines if line) == shown


def test_quiet_shows_nothing(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    for show in (progress(quiet=True), _progress(quiet=True)):
        show("write")
    end_progress(quiet=True)
    assert capsys.readouterr().err == ""

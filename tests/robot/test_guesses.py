"""Marks of guesses in a robot file: found in its text, kept on the robot, named by every identification."""

from __future__ import annotations

from pathlib import Path

import pytest

from biped import record, sway
from biped_robot import write_robot
from plantar.feet.identify import identify_feet
from plantar.inspection import inspect_log
from plantar.robot.guesses import Guess, guess_notes, read_guesses
from plantar.robot.model import load_robot
from plantar.whole_body.settings import DynamicsSettings
from plantar.whole_body.whole_logs import prepare_logs

TEXT = """\
# GUESS: stands before the first key
name: "a # GUESS: no comment"  # the name is known
imu: {name: chest, link: torso}  # GUESS ± 2 deg: its name
feet:
  left:
    bush: {xyz: [0, 0, -0.06]}  # GUESS ± 20 mm: 20 mm above the sole
    # GUESS: from the shapes

    sole:
      xyz: [0, 0, -0.09]
      polygon: [[0.1, 0.1], [-0.1, 0.1],
        [-0.1, -0.1]]  # GUESSED is another word
# GUESS: nothing follows
"""


def test_marks_are_found_with_their_key_reason_and_spread() -> None:
    found = read_guesses(TEXT.encode())
    assert [guess.key for guess in found] == ["name", "imu", "feet.left.bush", "feet.left.sole"]
    assert found[1].spread == pytest.approx(0.0349, abs=1e-4)
    assert found[2] == Guess("feet.left.bush", "20 mm above the sole", pytest.approx(0.02))
    assert found[3] == Guess("feet.left.sole", "from the shapes")
    assert read_guesses(TEXT.encode("utf-16")) == found


def test_nothing_is_marked_where_nothing_is_said() -> None:
    assert read_guesses(b"name: a\n# a comment\nurdf: b  # c\n") == ()
    assert guess_notes("robot.yaml", ()) == []


def test_the_note_says_which_numbers_hang_on_what() -> None:
    (note,) = guess_notes("robot.yaml", read_guesses(TEXT.encode()))
    assert note.code == "guessed_geometry"
    assert note.severity == "warning"
    assert "the left foot's numbers depend on bush (± 20 mm) and sole" in note.text
    assert "all numbers depend on name and imu" in note.text


def test_every_result_names_what_is_still_a_guess(tmp_path: Path) -> None:
    path = write_robot(tmp_path)
    log = record(sway(duration=8.0))
    lines = path.read_text().splitlines()
    at = next(row for row, line in enumerate(lines) if line.strip() == "bush:")
    path.write_text("\n".join([*lines[:at], lines[at] + "  # GUESS ± 20 mm: thin", *lines[at + 1 :]]))
    robot = load_robot(path)
    assert robot.guesses == (Guess("feet.left.bush", "thin", pytest.approx(0.02)),)
    short = log.select(log.time < 0.3)  # too short for a fit
    settings = DynamicsSettings()
    for notes in (
        identify_feet(robot, [log]).notes,
        inspect_log(robot, log).notes,
        inspect_log(robot, short).notes,
        prepare_logs(robot, [log], [], settings, lambda _: None).notes,
    ):
        (said,) = [note for note in notes if note.code == "guessed_geometry"]
        assert "left foot's numbers depend on bush (± 20 mm)" in said.text
    path.write_text("\n".join(lines))
    assert load_robot(path).guesses == ()

"""Notes that are alike are said once, of all logs together."""

from __future__ import annotations

import io

from rich.console import Console

from plantar.cli.console.terminal import SCREENFUL, print_notes
from plantar.notes import Note, NoteKind, joined, kinds, listing

LOGS = ["walk_1", "walk_2", "walk_3", "walk_4"]


def test_what_is_said_alike_of_several_logs_is_one_note() -> None:
    notes = [Note("gyroscope_missing", "warning", f"{log}: no angular velocity") for log in LOGS]
    assert joined(notes, LOGS) == (
        Note("gyroscope_missing", "warning", "4 logs (walk_1, walk_2, walk_3, ...): no angular velocity"),
    )


def test_what_differs_stays_apart_and_in_order() -> None:
    notes = [
        Note("weight", "warning", "walk_1: carries 60 kg"),
        Note("delay", "info", "walks are 3 ms late: corrected"),
        Note("weight", "warning", "walk_2: carries 61 kg"),
        Note("weight", "warning", "walk_1: carries 60 kg"),
    ]
    assert joined(notes, LOGS) == tuple(notes[:3])


def test_a_note_of_one_log_keeps_its_name() -> None:
    note = Note("spikes", "info", "walk_3: lone samples bridged")
    assert joined([note], LOGS) == (note,)


def test_the_terminal_shows_a_screenful_warnings_first() -> None:
    notes = [Note(f"a{k}", "info", f"remark {k}") for k in range(SCREENFUL + 3)]
    notes.append(Note("b", "warning", "look here"))
    out = io.StringIO()
    print_notes(Console(file=out, width=100), notes)
    lines = out.getvalue().splitlines()
    assert "look here" in lines[0]
    assert len(lines) == SCREENFUL + 1
    assert "4 more notes" in lines[-1]


def test_a_screenful_is_lines_and_long_warnings_take_several() -> None:
    """Each warning takes two lines of 100 columns: eight fill the screen, and none is cut in the middle."""
    notes = [Note("far", "warning", f"{place}: {'a long way ' * 10}") for place in range(10)]
    out = io.StringIO()
    print_notes(Console(file=out, width=100), notes)
    lines = out.getvalue().splitlines()
    assert len(lines) == SCREENFUL + 1 == 17
    assert lines[-1] == "and 2 more notes, in the result's notes"
    one = io.StringIO()
    print_notes(Console(file=one, width=100), notes, room=1)
    assert one.getvalue().splitlines() == [*lines[:2], "and 9 more notes, in the result's notes"]


def test_the_terminal_says_once_what_many_logs_say_alike() -> None:
    notes = [Note("air_zero", "info", f"{log}: reads 3 N in the air") for log in LOGS]
    notes += [
        Note("sign", "warning", "left: check the sign"),
        Note("sign", "warning", "right: check the sign"),
    ]
    out = io.StringIO()
    print_notes(Console(file=out, width=100), notes)
    lines = out.getvalue().splitlines()
    assert [line.count("check the sign") for line in lines] == [1, 1, 0], "a warning is never counted away"
    assert "walk_1: reads 3 N in the air (and 3 more like it" in lines[2]


def test_notes_of_one_kind_are_one_and_rare_kinds_come_first() -> None:
    notes = [
        Note("spikes", "warning", "walk_1: one sample bridged"),
        Note("delay", "info", "3 ms late"),
        Note("spikes", "warning", "walk_2: two samples bridged"),
        Note("delay_unknown", "warning", "delay unknown"),
    ]
    assert kinds(notes, "warning") == (
        NoteKind("delay_unknown", "warning", "delay unknown", ()),
        NoteKind("spikes", "warning", "walk_1: one sample bridged", ("walk_2: two samples bridged",)),
    )
    assert kinds((), "info") == ()


def test_a_long_list_is_cut_and_counted() -> None:
    assert listing(["a", "b", "c"], 3) == "a, b, c"
    assert listing(["a", "b", "c", "d", "e"], 3) == "a, b, c and 2 more"
    assert listing([]) == ""

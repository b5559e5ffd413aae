"""What `plantar fleet run` says of its work."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import pytest

from plantar.cli.fleet import report
from plantar.cli.fleet.run import _duration, counts
from plantar.fleet.run import Outcome
from plantar.fleet.tables import Written


@pytest.mark.parametrize(
    ("seconds", "said"),
    [(89.4, "89 s"), (90.0, "2 min"), (5399.0, "90 min"), (5400.0, "1.5 h"), (9000, "2.5 h")],
)
def test_a_time_is_told_in_the_unit_that_suits_it(seconds: float, said: str) -> None:
    assert _duration(seconds) == said


def test_the_last_line_counts_what_came_of_the_groups() -> None:
    outcome = Outcome(9, 2, 6, Written(finished=7, failed=2, failures=5), 60.0, 100.0)
    assert counts(outcome) == (
        "9 groups: 7 with results, 2 were there already, 2 failed, 5 failures in failures.parquet"
    )


@pytest.mark.parametrize(
    ("asked", "said"), [({"quiet": True}, []), ({}, ["alarms", "fleet.html"]), ({"json": True}, ["{"])]
)
def test_a_report_says_its_alarms_and_page_but_when_it_is_to_be_quiet(
    asked: dict[str, bool],
    said: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    summary, rates = SimpleNamespace(to_dict=lambda: {"robots": 3}), list[float]()
    monkeypatch.setattr(report, "write_report", lambda _, rate: rates.append(rate) or summary)
    monkeypatch.setattr(report, "print_summary", lambda _: print("alarms"))
    report.run(str(tmp_path), false_alarms=0.5, **asked)
    text = capsys.readouterr().out
    assert rates == [0.5]
    if asked.get("json"):
        assert json.loads(text) == {"robots": 3}
    else:
        assert [line.rpartition("/")[2] for line in text.split()] == said

"""What a campaign leaves on paper: its figures in their order, the simulator's where motions were replayed."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from plantar.campaign import present
from plantar.report import Section


@pytest.mark.parametrize("replayed", [(), ("a row",)])
def test_figures_with_numbers_come_first_and_the_simulator_has_a_section(
    replayed: tuple[str, ...], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def plate(name: str, number: int | None) -> Any:
        return SimpleNamespace(
            name=name, number=number, drawing=f"drawn {name}", picture=lambda: f"picture {name}"
        )

    seen: dict[str, Any] = {}
    simulator = [plate("simulator", None)] if replayed else []
    monkeypatch.setattr(present.pictures, "plates", lambda _: [plate("figure05", 5), *simulator])
    monkeypatch.setattr(
        present.paper_plates, "plates", lambda tracks, only_paper: [plate("figure03", 3)] * only_paper
    )
    monkeypatch.setattr(present, "save", lambda drawing, folder, name: [folder / f"{name}.svg"])
    monkeypatch.setattr(present.tables, "tables", lambda _: ("table 1",))
    monkeypatch.setattr(present.tables, "replay_table", lambda rows: ("every motion", rows))
    monkeypatch.setattr(present, "write_campaign_scene", lambda _, path: path)
    monkeypatch.setattr(
        present, "write_feet_report", lambda folder, **more: seen.update(more) or folder / "report.html"
    )
    campaign = SimpleNamespace(directory=tmp_path, replayed=replayed)
    written = present.write_campaign_report(campaign, progress=lambda _: None)  # type: ignore[arg-type]
    names = ["figure03", "figure05", *(one.name for one in simulator)]
    assert written.figures == tuple(tmp_path / "figures" / f"{name}.svg" for name in names)
    assert (written.report, written.scene) == (tmp_path / "report.html", tmp_path / "robot.html")
    assert seen["figures"] == ["picture figure03", "picture figure05"]
    beside, *more = seen["sections"]
    assert isinstance(beside, Section)
    assert (beside.title, beside.tables) == ("Beside the paper", ("table 1",))
    assert [(one.title, one.tables, one.figures) for one in more] == [
        ("In a simulator", (("every motion", replayed),), ("picture simulator",))
    ] * bool(replayed)

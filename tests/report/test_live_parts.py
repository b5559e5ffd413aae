"""Everything that the live view hands to its server: shapes, places, colours, words and plots, as they are kept."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from biped_robot import robot_entry, write_robot
from kept_texts import assert_as_kept, described
from plantar.online.estimates import AxisEstimate, Contact, Estimated, Flag, FootEstimate
from plantar.report import live
from plantar.robot.model import load_robot

pytest.importorskip("viser")
UNKNOWN = Estimated(10.0, 5.0, 10.5)
PITCH = AxisEstimate(
    0.012, 0.1, 6.0, Estimated(500.0, 10.0, 25.0), Estimated(20.0, 1.0, 3.0), UNKNOWN, 0.3, True
)
ROLL = replace(PITCH, deflection=-0.004, stiffness=UNKNOWN, identified=False)
STANDS = FootEstimate(Contact.STANCE, 412.4, (0.021, -0.013), Flag(0), 0.001, UNKNOWN, PITCH, ROLL)
FLIES = replace(
    STANDS, contact=Contact.AIR, load=3.2, flags=Flag.NOT_STANDING | Flag.ROLL_UNKNOWN, pitch=ROLL, roll=PITCH
)


class Server:
    """Keeps each thing that is added to it, by what adds it and its name."""

    def __init__(self) -> None:
        self.kept: dict[str, SimpleNamespace] = {}
        self.scene = self.gui = self

    def atomic(self) -> nullcontext[None]:
        return nullcontext()

    def add_folder(self, name: str) -> nullcontext[None]:
        self.kept[f"folder {name}"] = SimpleNamespace()
        return nullcontext()

    def __getattr__(self, kind: str) -> Any:
        def add(*given: Any, **named: Any) -> SimpleNamespace:
            made = SimpleNamespace(given=given, **named)
            self.kept[f"{len(self.kept)} {kind}"] = made
            return made

        return add


def test_what_is_drawn_of_two_feet_is_as_it_is_kept(tmp_path: Path) -> None:
    """The right sole is smaller, sits askew under its ankle, and flies; the left one stands."""
    entry: Any = robot_entry()
    entry["feet"]["right"]["sole"]["polygon"] = [
        [0.08, 0.03],
        [-0.1, 0.04],
        [-0.1, -0.05],
        [0.08, -0.05],
        [0.0, 0.0],
    ]
    entry["feet"]["right"]["bush"]["xyz"] = [0.02, -0.01, -0.05]
    robot = load_robot(write_robot(tmp_path, feet=entry["feet"]))
    server, view = Server(), live.LiveView.__new__(live.LiveView)
    view.server = server  # type: ignore[assignment]
    order = live.from_the_right(robot)
    view._feet = {
        name: live._FootView(server, robot, name, order.index(name))  # type: ignore[arg-type]
        for name in robot.feet
    }
    view._next = 0.0
    view.show(3.0, {"left": STANDS, "right": FLIES})
    view.show(3.5, {"left": replace(STANDS, contact=Contact.LANDING, flags=Flag.SLIP), "right": FLIES})
    text = "".join(described(vars(one), name) for name, one in server.kept.items())
    assert_as_kept(text, Path(__file__).parent / "kept" / "live.txt")

"""The comparison as a picture: chest attitude and foot torques, recorded and simulated, a column a motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from plantar.comparison.scenes import CONTACT
from plantar.conventions import Array
from plantar.report.figures.plots import Format, save
from plantar.report.figures.simulation import MotionReplayed, replays
from plantar.twin.replay import Replayed

CHEST = ("chest pitch", "chest roll")
MILLI = 1e3


def write_picture(
    folder: Path, found: Sequence[Replayed], formats: Sequence[Format] = ("svg",)
) -> list[Path]:
    """Write `comparison.svg`, or other formats, to a folder; the paths. Raises MissingExtra without matplotlib."""
    motions = []
    for motion in dict.fromkeys(one.motion for one in found):
        group = [one for one in found if one.motion == motion]
        simulated = {one.feet: _labelled(one.chest, one.torque) for one in group}
        recorded = _labelled(group[0].recorded_chest, group[0].recorded_torque)
        motions.append(MotionReplayed(motion, group[0].time, recorded, simulated))
    rows = [(name, f"{name}\n[mrad]", MILLI) for name in CHEST]
    rows += [(f"{foot} {axis}", f"{foot} {axis}\ntorque [N·m]", 1.0) for foot, axis in found[0].torque]
    return save(replays(motions, rows, CONTACT), folder, "comparison", formats)


def _labelled(chest: Array, torque: Mapping[tuple[str, str], Array]) -> dict[str, Array]:
    named = dict(zip(CHEST, chest.T, strict=True))
    return named | {f"{foot} {axis}": values for (foot, axis), values in torque.items()}

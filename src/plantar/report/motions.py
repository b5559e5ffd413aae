"""What the page shows of each motion: its timeline, which plots it has, and how well it was reconstructed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from plantar.contact.phases import Phase
from plantar.conventions import AXES
from plantar.report.payload import Payload, encode
from plantar.results.feet import FeetResult
from plantar.results.numbers import number
from plantar.results.residuals import Track

ROLES: Final = {"fit": "used for the fit", "validate": "not seen by the fit"}
PHASE_LIMIT: Final = 4000
"""Most phases that a timeline draws."""


@dataclass(frozen=True)
class Lane:
    """One foot's phases in a motion."""

    foot: str
    phases: tuple[Phase, ...]


@dataclass(frozen=True)
class Plot:
    """One plot to be drawn by the browser: `kind` is angles, force, pressure, torque or loop."""

    kind: str
    title: str
    description: str
    foot: str = ""
    axis: str = ""


@dataclass(frozen=True)
class FootPlots:
    """One foot's plots in a motion; `used` is false where all its samples were left out."""

    foot: str
    used: bool
    plots: tuple[Plot, ...]


@dataclass(frozen=True)
class MotionView:
    """A motion of the report; `payload` is None where the residuals lack it."""

    name: str
    role: str
    summary: str
    start: float
    end: float
    lanes: tuple[Lane, ...]
    both: tuple[Plot, ...]
    feet: tuple[FootPlots, ...]
    payload: Payload | None


def motion_views(result: FeetResult, tracks: Sequence[Track]) -> tuple[list[MotionView], int]:
    """The residuals' motions, then those that only phases name, and the stride of the drawn samples."""
    drawn = list(dict.fromkeys(track.motion for track in tracks))
    groups = [[track for track in tracks if track.motion == name] for name in drawn]
    payloads, stride = encode(groups)
    views = [_view(result, *motion) for motion in zip(drawn, groups, payloads, strict=True)]
    bare = [name for name in dict.fromkeys(phase.motion for phase in result.phases) if name not in drawn]
    return views + [_view(result, name, [], None) for name in bare], stride


def _view(result: FeetResult, name: str, tracks: Sequence[Track], payload: Payload | None) -> MotionView:
    phases = [phase for phase in result.phases if phase.motion == name][:PHASE_LIMIT]
    ends = [(float(track.time[0]), float(track.time[-1])) for track in tracks]
    ends += [(phase.start, phase.end) for phase in phases]
    start, end = min(low for low, _ in ends), max(high for _, high in ends)
    names = dict.fromkeys([track.foot for track in tracks] + [phase.foot for phase in phases])
    lanes = tuple(Lane(foot, tuple(phase for phase in phases if phase.foot == foot)) for foot in names)
    role = tracks[0].role if tracks else ""
    return MotionView(
        name=name,
        role=ROLES.get(role, role),
        summary=_summary(result, name, end - start),
        start=start,
        end=max(end, start + 1e-3),
        lanes=tuple(lane for lane in lanes if lane.phases),
        both=tuple(_both(tracks)),
        feet=tuple(FootPlots(track.foot, bool(track.used.any()), tuple(_foot(track))) for track in tracks),
        payload=payload,
    )


def _summary(result: FeetResult, name: str, duration: float) -> str:
    rows = [row for row in result.validation if row.motion == name]
    errors = [f"{row.foot} {row.axis} {number(row.mean_abs_error, 2)}" for row in rows if row.axis != "z"]
    text = f"{number(duration, 3)} s"
    return f"{text}; mean |error| {', '.join(errors)} N·m" if errors else text


def _both(tracks: Sequence[Track]) -> Iterable[Plot]:
    for axis in AXES:
        if any(axis in track.axes for track in tracks):
            what = "z displacement" if axis == "z" else f"{axis} angle"
            yield Plot("angles", f"Bush {what}", f"Bush {what} of each foot over time", axis=axis)
    if any("force_z" in track.values for track in tracks):
        yield Plot("force", "Vertical force", "Vertical force on each foot over time")
    if any("cop_x" in track.values and "cop_y" in track.values for track in tracks):
        yield Plot("pressure", "Centre of pressure", "Way of the centre of pressure in each foot's sole")


def _foot(track: Track) -> Iterable[Plot]:
    for axis in track.axes:
        what = "force" if axis == "z" else "torque"
        subject = f"{track.foot} {axis}"
        title = f"{subject}: measured and reconstructed {what}"
        yield Plot("torque", title, f"{title} over time", track.foot, axis)
        over = "displacement" if axis == "z" else "angle"
        title = f"{subject}: {what} over {over}"
        yield Plot("loop", title, f"{title}, the loop", track.foot, axis)

"""One page for those who stand beside the robot: what the motion does, its margins, what to watch, when to stop."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def sheet(content: Mapping[str, Any], approach: bool) -> str:
    """The page, in Markdown, from the content of MOTION.json."""
    settings, rehearsals = content["settings"], content["rehearsals"]
    soft, stiff = content["stiffness_range"]
    bend = max(one["bend"] for one in rehearsals)
    margin = min(one["sole_margin"] for one in rehearsals)
    load = min(one["least_load"] for one in rehearsals)
    gentler = (
        "Play the versions of 25 % and 50 % of the amplitude first."
        if approach
        else "Make gentler versions with `--approach` and play those first."
    )
    touch = content["self_collision"]
    ahead = 1e3 * content["right_foot_ahead"]["value"]
    placed = f", the right one {ahead:.0f} mm ahead of the left one" if ahead else ", side by side"
    watched = (
        f"No links touched: {touch['pairs']} pairs were watched, by the URDF's collision geometry."
        if touch["checked"]
        else "**The URDF's collision geometry was not found: nobody checked whether arms and trunk touch.**"
    )
    rows = [
        f"| {one['foot']} | {one['axis']} | {one['name']} | {_number(one['half_width_percent'])} | "
        f"{_number(one['error95_percent'])} |"
        for one in content["parameters"]
    ]
    limits = [
        f"| {one['limit']} {one['unit'] and '[' + one['unit'] + '] '}| {one['kept']:.3g} | {one['reached']:.3g} |"
        for one in content["limits"]
    ]
    return "\n".join(
        [
            f"# {content['robot']}: {content['motion']}",
            "",
            f"{settings['duration']:g} s, {settings['rate']:g} Hz, for feet of {settings['stiffness']:.4g} N·m/rad. "
            f"It holds from {soft:.4g} to {stiff:.4g} N·m/rad. Softer than {content['least_stiffness']:.4g} N·m/rad "
            "they cannot hold this robot upright.",
            "",
            "## What it does",
            "",
            "The robot stands on both feet and starts and ends still. It leads its weight over one foot and turns that "
            "ankle, sways its trunk, swings its arms and goes up and down by some millimetres; after half the time it "
            "does the same over the other foot. The "
            "soles stay flat: what an ankle turns is what the rubber bends.",
            "",
            _one_foot(content),
            "",
            "## Before",
            "",
            "- Move slowly to the first row. Both soles stand flat on a hard, level floor, placed as in that row"
            f"{placed}.",
            "- The robot hangs in its crane with a slack rope; someone holds the emergency stop.",
            "- Joints are position controlled, the stabiliser is off: it would work against the motion.",
            f"- {gentler}",
            "",
            "## Watch, and when to stop",
            "",
            f"- Centres of pressure stay {1e3 * margin:.0f} mm inside each sole. Stop when a sole's edge lifts.",
            f"- No foot carries less than {100 * load:.0f} % of what it carries at rest. Stop when one slips or steps.",
            f"- The soles bend by {bend:.3f} rad ({57.3 * bend:.1f}°) at most. Stop when the robot leans by more than "
            "twice that: the feet are softer than told.",
            "- Stop when a gentler version moved the chest more than its share: the robot resonates.",
            "",
            "## Limits that it kept",
            "",
            "| limit | allowed | reached |",
            "|---|---|---|",
            *limits,
            "",
            watched,
            "",
            "## What it promises",
            "",
            "| foot | axis | parameter | 95 % half width [%] | 95 % are off by less, at the worst stiffness [%] |",
            "|---|---|---|---|---|",
            *rows,
            "",
            "What plays are off by is beside the sensors' gains, which no motion shows.",
            "",
            *_common(content),
            "",
            *(f"- {note}." for note in content["notes"]),
            "",
        ]
    )


def _one_foot(content: Mapping[str, Any]) -> str:
    """Why it does not stand on one foot."""
    needed, soft = content["one_foot"]["least_stiffness"], content["stiffness_range"][0]
    most = 100 * (1 - min(one["least_load"] for one in content["rehearsals"]) / 2)
    why = (
        f"one foot has to be stiffer than {needed:.4g} N·m/rad to hold it alone, and may be as soft as {soft:.4g}"
        if soft < needed
        else f"feet of {soft:.4g} N·m/rad could hold it, but a foot that lands could slip or step"
    )
    return f"It does not stand on one foot: {why}. A foot carries up to {most:.0f} % of the weight."


def _common(content: Mapping[str, Any]) -> list[str]:
    """What both feet share, the widest of all rehearsals: delay of the force sensors, vertical compliance."""
    delays = [one["half_width"] for one in content["sensor_delay"]["at"]]
    vertical = [one["half_width_percent"] for one in content["vertical_compliance"]["at"]]
    wanted = content["wanted"]
    late = "not measured" if None in delays else f"within {1e3 * max(delays):.2g} ms"
    pressed = "not identified" if None in vertical else f"within {max(vertical):.2g} %"
    return [
        f"- Delay of the force sensors: {late}.",
        f"- Vertical compliance, the sum of both feet: {pressed}, most of it what the robot file may be off by.",
        f"- The search wanted: stiffness within {wanted['stiffness_percent']:g} %, damping within "
        f"{wanted['damping_percent']:g} %, delay within {1e3 * wanted['sensor_delay']:g} ms, vertical compliance "
        f"within {wanted['vertical_compliance_percent']:g} %.",
    ]


def _number(value: float | None) -> str:
    return "not identified" if value is None else f"{value:.3g}"

"""The page for those who stand beside the robot: each number of MOTION.json in its line and in its unit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from kept_texts import assert_as_kept
from plantar.design.writing.sheet import sheet

CONTENT: dict[str, Any] = {
    "robot": "talos",
    "motion": "probe",
    "least_stiffness": 123.0,
    "stiffness_range": [400.0, 1600.0],
    "settings": {"duration": 40.0, "rate": 200.0, "stiffness": 800.0},
    "right_foot_ahead": {"value": 0.031, "unit": "m"},
    "one_foot": {"least_stiffness": 510.0},
    "self_collision": {"checked": True, "pairs": 37},
    "rehearsals": [
        {"bend": 0.02, "sole_margin": 0.014, "least_load": 0.8},
        {"bend": 0.05, "sole_margin": 0.011, "least_load": 0.7},
        {"bend": 0.03, "sole_margin": 0.012, "least_load": 0.9},
    ],
    "limits": [
        {"limit": "speed", "unit": "rad/s", "kept": 2.5, "reached": 1.23456},
        {"limit": "share", "unit": "", "kept": 0.5, "reached": 0.25},
    ],
    "parameters": [
        {
            "foot": "left",
            "axis": "roll",
            "name": "damping",
            "half_width_percent": 1.25,
            "error95_percent": 3.5,
        },
        {
            "foot": "right",
            "axis": "pitch",
            "name": "stiffness",
            "half_width_percent": None,
            "error95_percent": None,
        },
    ],
    "sensor_delay": {"at": [{"half_width": 0.0004}, {"half_width": 0.0012}, {"half_width": 0.0007}]},
    "vertical_compliance": {"at": [{"half_width_percent": 6.0}, {"half_width_percent": 8.5}]},
    "wanted": {
        "stiffness_percent": 0.5,
        "damping_percent": 2.0,
        "sensor_delay": 0.0005,
        "vertical_compliance_percent": 9.0,
    },
    "notes": ["the floor gives way"],
}


@pytest.mark.parametrize(
    "told",
    [
        "# talos: probe",
        "40 s, 200 Hz, for feet of 800 N·m/rad. It holds from 400 to 1600 N·m/rad. Softer than 123 "
        "N·m/rad they cannot hold",
        "one foot has to be stiffer than 510 N·m/rad to hold it alone, and may be as soft as 400. A foot "
        "carries up to 65 % ",
        "the right one 31 mm ahead of the left one.",
        "- Play the versions of 25 % and 50 % of the amplitude first.",
        "stay 11 mm inside each sole.",
        "No foot carries less than 70 % of what it carries at rest.",
        "bend by 0.050 rad (2.9°) at most.",
        "|---|---|---|\n| speed [rad/s] | 2.5 | 1.23 |\n| share | 0.5 | 0.25 |\n\nNo links touched: 37 pairs",
        "|---|---|---|---|---|\n| left | roll | damping | 1.25 | 3.5 |\n"
        "| right | pitch | stiffness | not identified | not identified |\n",
        "- Delay of the force sensors: within 1.2 ms.",
        "the sum of both feet: within 8.5 %,",
        "stiffness within 0.5 %, damping within 2 %, delay within 0.5 ms, vertical compliance within 9 %.",
        "\n- the floor gives way.\n",
    ],
)
def test_each_number_stands_in_its_line(told: str) -> None:
    assert told in sheet(CONTENT, approach=True)


def test_what_one_rehearsal_does_not_measure_is_not_measured() -> None:
    lacks = {"sensor_delay": {"at": [{"half_width": 0.001}, {"half_width": None}]},
             "vertical_compliance": {"at": [{"half_width_percent": None}]}}  # fmt: skip
    page = sheet(CONTENT | lacks | {"self_collision": {"checked": False}}, approach=False)
    assert "- Delay of the force sensors: not measured." in page
    assert "both feet: not identified," in page
    assert "nobody checked whether arms and trunk touch" in page
    assert "- Make gentler versions with `--approach`" in page


@pytest.mark.parametrize("approach", [True, False])
def test_the_whole_sheet_is_as_it_is_kept(approach: bool) -> None:
    """Without limits on one foot and the links unwatched where there are no gentler versions."""
    content = (
        CONTENT
        if approach
        else CONTENT | {"self_collision": {"checked": False}, "right_foot_ahead": {"value": 0.0}}
    )
    assert_as_kept(sheet(content, approach), Path(__file__).parent / "kept" / f"sheet_{approach}.txt")

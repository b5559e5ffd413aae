"""A made-up feet result with residuals, as large and as ugly as a report must bear."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet

HOSTILE = "</script ><img src=x onerror=alert(1)>\u2028'\""
SOLE = [[0.13, 0.06], [-0.09, 0.06], [-0.09, -0.06], [0.13, -0.06]]
TRUTH = {  # the paper's table 1
    ("right", "pitch"): (434.0, 15.89, 4.79),
    ("right", "roll"): (323.0, 17.53, -0.05),
    ("left", "pitch"): (480.0, 24.27, 5.66),
    ("left", "roll"): (352.0, 28.15, -4.12),
}
MOTIONS = (
    ("manual_right_roll", "fit", "right"),
    ("manual_right_pitch", "fit", "right"),
    ("manual_left_roll", "fit", "left"),
    ("manual_left_pitch", "fit", "left"),
    ("tilt3", "fit", "both"),
    ("tilt1", "validate", "both"),
    ("squat", "validate", "both"),
    ("myrand4", "validate", "both"),
    (HOSTILE, "validate", "both"),
)


@dataclass(frozen=True)
class Campaign:
    """A directory with `result.json` and `residuals.parquet`, and what is in them."""

    directory: Path
    result: dict[str, Any]
    columns: dict[str, np.ndarray]

    @property
    def rows(self) -> int:
        return len(self.columns["time"])


def write_campaign(directory: Path, seconds: float = 60.0, rate: float = 200.0) -> Campaign:
    """Random sways of both feet with noise, stretches of NaN in the air and samples left out."""
    rng = np.random.default_rng(4)
    parts: list[dict[str, np.ndarray]] = []
    phases: list[dict[str, Any]] = []
    for motion, role, standing in MOTIONS:
        for foot in ("left", "right"):
            part, spans = _track(rng, motion, role, foot, standing, seconds, rate)
            parts.append(part)
            phases += spans
    columns = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    result = _result(columns, phases)
    directory.mkdir(parents=True, exist_ok=True)
    pyarrow.parquet.write_table(pa.table(columns), directory / "residuals.parquet")
    (directory / "result.json").write_text(json.dumps(result), encoding="utf-8")
    return Campaign(directory, result, columns)


def _track(
    rng: np.random.Generator, motion: str, role: str, foot: str, standing: str, seconds: float, rate: float
) -> tuple[dict[str, np.ndarray], list[dict[str, Any]]]:
    time = np.arange(round(seconds * rate)) / rate
    n = time.size
    air = standing not in ("both", foot)
    support = np.full(n, "air" if air else "double" if standing == "both" else "single", dtype=object)
    used = np.full(n, not air)
    spans = [(0.0, time[-1], str(support[0]), not air, "the foot is in the air" if air else None)]
    if not air:
        cut = (time > 0.4 * seconds) & (time < 0.45 * seconds)
        support[cut], used[cut] = "transition", False
        low, high = 0.4 * seconds, 0.45 * seconds
        kind = str(support[0])
        reason = f"sole tips over its edge in <b>{motion}</b>"
        spans = [(0.0, low, kind, True, None), (low, high, "transition", False, reason),
                 (high, float(time[-1]), kind, True, None)]  # fmt: skip
    part = {
        "motion": np.full(n, motion, dtype=object),
        "role": np.full(n, role, dtype=object),
        "foot": np.full(n, foot, dtype=object),
        "time": time,
        "used": used,
        "support": support,
        "force_z": np.where(air, 0.0, 280.0) + rng.normal(0, 1, n),
        "cop_x": np.where(air, np.nan, rng.normal(0, 0.01, n)),
        "cop_y": np.where(air, np.nan, rng.normal(0, 0.01, n)),
    }
    for axis, amplitude in (("pitch", 0.1), ("roll", 0.05)):
        stiffness, damping, offset = TRUTH[foot, axis]
        phase = 2 * np.pi * (0.1 + 0.4 * rng.random()) * time
        swell = amplitude * np.sin(2 * np.pi * time / seconds / 1.7)
        deflection = np.zeros(n) if air else swell * np.sin(phase)
        rate_of = np.gradient(deflection, time)
        ideal = stiffness * deflection + damping * rate_of + offset
        slow = np.cumsum(rng.normal(0, 0.02, n))
        part[f"{axis}.deflection"] = deflection + rng.normal(0, 2e-5, n)
        part[f"{axis}.rate"] = rate_of + rng.normal(0, 1.5e-3, n)
        part[f"{axis}.torque"] = (0.0 if air else 1.0) * (ideal + slow) + rng.normal(0, 0.1, n)
        part[f"{axis}.predicted"] = np.where(used, ideal + rng.normal(0, 0.03, n), np.nan)
    rows = [
        {"motion": motion, "foot": foot, "start": a, "end": b, "support": s, "used": u, "reason": r}
        for a, b, s, u, r in spans
    ]
    return part, rows


def _result(columns: dict[str, np.ndarray], phases: list[dict[str, Any]]) -> dict[str, Any]:
    parameters, shared, validation, offsets = [], [], [], []
    for (foot, axis), (stiffness, damping, offset) in TRUTH.items():
        bad = (foot, axis) == ("right", "roll")
        for name, unit, value, std in (
            ("stiffness", "N.m/rad", stiffness, 0.5), ("damping", "N.m.s/rad", damping, 0.2)
        ):  # fmt: skip
            verdict = "usable" if not bad else "weak" if name == "stiffness" else "unidentifiable"
            row = {"foot": foot, "axis": axis, "name": name, "unit": unit, "value": value, "std": std,
                   "interval95": [value - 2 * std, value + 2 * std], "relative_std_percent": 0.01,
                   "verdict": verdict, "reason": "", "advice": None}  # fmt: skip
            if bad:
                row["reason"] = f"roll hardly moves (0.3 mrad) <script>alert('{name}')</script>"
                row["advice"] = "record manual_right_roll with 20 mrad or more"
            parameters.append(row)
            shared.append(row | {"value": value * 1.05, "verdict": "usable"})
        for motion, role, standing in MOTIONS:
            if standing not in ("both", foot):
                continue
            chosen = (columns["motion"] == motion) & (columns["foot"] == foot) & columns["used"].astype(bool)
            torque, predicted = columns[f"{axis}.torque"][chosen], columns[f"{axis}.predicted"][chosen]
            error = np.abs(torque - predicted)
            largest = np.abs(torque).max()
            zero = (
                0.01 if (motion, foot, axis) == ("squat", "right", "roll") else np.abs(torque - offset).mean()
            )
            validation.append(
                {"kind": "direct" if role == "fit" else "cross", "motion": motion, "foot": foot, "axis": axis,
                 "mean_abs_error": error.mean(), "rms_error": np.sqrt((error**2).mean()), "max_abs": largest,
                 "percent_of_max": 100 * error.mean() / largest, "zero_mean_abs": zero,
                 "samples": int(chosen.sum())})  # fmt: skip
            offsets.append(
                {"foot": foot, "axis": axis, "motion": motion, "unit": "N.m", "value": offset, "std": 0.02}
            )
    worse = [row | {"mean_abs_error": 2.5 * row["mean_abs_error"]} for row in validation]
    return {
        "schema": "plantar.feet/1",
        "robot": "hrp2-like <b>",
        "plantar": "0.1.0",
        "created": "2026-01-01T00:00:00Z",
        "inputs": [{"path": f"/logs/{m}.csv", "sha256": "ab" * 32, "role": role} for m, role, _ in MOTIONS],
        "settings": {"offset": "per-motion", "filter": {"cutoff_hz": 20.0, "name": HOSTILE}},
        "model": "kelvin_voigt",
        "robot_model": {"feet": {foot: {"sole": {"polygon": SOLE}} for foot in ("left", "right")}},
        "parameters": parameters,
        "offsets": offsets,
        "phases": phases,
        "validation": validation,
        "notes": [
            {"code": "imu.drift", "severity": "info", "text": f"yaw is not used in {HOSTILE}"},
            {"code": "contact.edge", "severity": "warning", "text": "the right sole tips in tilt3 at 24.0 s"},
        ],
        "comparisons": [
            {
                "name": "offset shared",
                "settings": {"offset": "shared"},
                "parameters": shared,
                "validation": worse,
            }
        ],
        "diagnosis": [
            {
                "foot": foot,
                "axis": axis,
                "name": "stiffness",
                "limit": "noise",
                "variance_shares": {"noise": 1.0},
                "half_width_percent": width,
                "text": text,
            }
            for foot, axis, width, text in (
                ("right", "roll", 0.3, "Record 60 s of manual_right_roll to halve the widest interval."),
                ("left", "pitch", 0.2, "left pitch: noise limits it"),
            )
        ],
    }

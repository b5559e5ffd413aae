"""Ranges to train with: the covariance that the causes give, and draws that have it."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from export_robots import TRUTH, result, write_urdf
from page_blocks import ROOT, blocks
from plantar.exporters import export
from pushed_foot import other_python


@pytest.fixture
def feet(tmp_path: Path) -> dict[str, Any]:
    """A result whose dampings share a late sensor, and whose numbers of one foot share its sensor's gain."""
    made = result(write_urdf(tmp_path / "biped.urdf"))
    made["latency"] = {"wrench_delay": 0.005, "std": 0.002}
    made["diagnosis"] = [
        {"foot": foot, "axis": axis, "name": name,
         "variance_shares": {"sensor gain": 0.36, "delay": 0.16, "noise": 0.48} if name == "stiffness"
         else {"sensor gain": 0.09, "delay": 0.64, "noise": 0.27}}
        for foot, axes in TRUTH.items() for axis in axes for name in ("stiffness", "damping")
    ]  # fmt: skip
    return made


def ranges(feet: dict[str, Any], folder: Path) -> tuple[dict[str, Any], dict[str, int]]:
    export(feet, "randomization", folder / "ranges.yaml")
    made = yaml.safe_load((folder / "ranges.yaml").read_text())
    return made, {row["name"]: place for place, row in enumerate(made["parameters"])}


@pytest.mark.parametrize(
    ("latency", "known"),
    [
        ({"wrench_delay": 0.005, "std": 0.002}, True),
        ({"wrench_delay": 0.005, "std": None}, False),
        ({"wrench_delay": None, "std": 0.002}, False),
        ({}, False),
        (None, False),
    ],
)
def test_a_delay_without_its_deviation_is_no_range(
    latency: dict[str, float | None] | None, known: bool, feet: dict[str, Any], tmp_path: Path
) -> None:
    feet["latency"] = latency
    assert ("wrench.delay" in ranges(feet, tmp_path)[1]) is known


def test_numbers_that_share_a_cause_are_correlated(feet: dict[str, Any], tmp_path: Path) -> None:
    made, place = ranges(feet, tmp_path)
    matrix = np.array(made["correlation"])

    def between(one: str, other: str) -> float:
        return float(matrix[place[one], place[other]])

    assert between("left.pitch.stiffness", "left.roll.stiffness") == pytest.approx(0.36)
    assert between("left.pitch.stiffness", "left.roll.damping") == pytest.approx(0.6 * 0.3)
    assert between("left.pitch.stiffness", "right.pitch.stiffness") == 0, "each foot has its own sensor"
    assert between("left.pitch.damping", "right.roll.damping") == pytest.approx(0.64), "one clock for both"
    assert between("left.pitch.damping", "left.roll.damping") == pytest.approx(0.64 + 0.09)
    assert between("wrench.delay", "left.pitch.damping") == pytest.approx(0.8)
    assert between("wrench.delay", "left.pitch.stiffness") == 0, "late sensors are of the dampings alone"
    assert between("left.pitch.offset", "left.pitch.stiffness") == 0
    assert (np.diag(matrix) == 1).all()
    np.testing.assert_array_equal(matrix, matrix.T)
    assert np.linalg.eigvalsh(matrix).min() > -1e-3  # to the four digits that are written


def test_means_and_deviations_are_the_identified_ones(feet: dict[str, Any], tmp_path: Path) -> None:
    feet["robot_model"]["uncertainty"] = {"imu_mount": 0.0, "encoder_zero": 0.0}
    made, place = ranges(feet, tmp_path)
    rows = made["parameters"]
    for foot, axes in TRUTH.items():
        for axis, (k, c, o) in axes.items():
            for name, value in (("stiffness", k), ("damping", c)):
                row = rows[place[f"{foot}.{axis}.{name}"]]
                assert (row["mean"], row["std"], row["above"]) == pytest.approx((value, 0.01 * value, 0))
            zero = rows[place[f"{foot}.{axis}.offset"]]
            assert (zero["mean"], zero["std"]) == pytest.approx((o, np.std([-0.5, 0.5], ddof=1)))
    late = rows[place["wrench.delay"]]
    assert (late["mean"], late["std"], late["unit"]) == (0.005, 0.002, "s")
    assert made["independent"][0]["measured"] is False


def test_rubber_that_slips_is_drawn_as_the_model_holds_it(feet: dict[str, Any], tmp_path: Path) -> None:
    """K and C beside the slip, as `mjcf` writes them, not the linear equivalent; its sensor scales them together."""
    slip = {"slip_torque": (5.0, 0.05), "slip_angle": (0.01, 0.0002)}
    for name, (value, std) in slip.items():
        feet["parameters"].append(
            {"foot": "left", "axis": "pitch", "name": name, "unit": "", "value": value, "std": std,
             "interval95": None, "verdict": "usable"}
        )  # fmt: skip
    feet["diagnosis"].append(
        {"foot": "left", "axis": "pitch", "name": "slip_torque", "variance_shares": {"sensor gain": 0.25}}
    )
    nearest = {"stiffness": 600.0, "damping": 50.0}
    feet["laws"] = [{"foot": "left", "axis": "pitch", "law": "elastoplastic", "linear_equivalent": nearest}]
    made, place = ranges(feet, tmp_path)
    rows, matrix = made["parameters"], np.array(made["correlation"])
    for name, (value, std) in slip.items():
        row = rows[place[f"left.pitch.{name}"]]
        assert (row["mean"], row["std"], row["above"]) == pytest.approx((value, std, 0))
    assert rows[place["left.pitch.stiffness"]]["mean"] == TRUTH["left"]["pitch"][0]
    assert matrix[place["left.pitch.slip_torque"], place["left.roll.stiffness"]] == pytest.approx(0.5 * 0.6)
    assert not any(name.startswith("right") and "slip" in name for name in place)


def test_a_thousand_draws_have_the_covariance(
    feet: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the lines of the page, typed as they stand there."""
    made, _ = ranges(feet, tmp_path)
    page = ROOT / "docs" / "how_to" / "randomisation.md"
    lines = next(block for block in blocks(page) if "multivariate_normal" in block.text)
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(compile(lines.text, lines.where, "exec"), names)
    draws = names["draws"]
    assert draws.shape == (1000, len(made["parameters"]))
    mean, std = (np.array([row[key] for row in made["parameters"]]) for key in ("mean", "std"))
    # Of 1,000 draws: a mean is right to 3.2 % of its deviation, a deviation to 2.2 %, a correlation to 0.032.
    np.testing.assert_allclose((draws.mean(axis=0) - mean) / std, 0, atol=0.13)
    np.testing.assert_allclose(draws.std(axis=0) / std, 1, atol=0.1)
    np.testing.assert_allclose(np.corrcoef(draws.T), made["correlation"], atol=0.13)


def test_what_has_no_deviation_is_said(feet: dict[str, Any], tmp_path: Path) -> None:
    for row in feet["parameters"]:
        if (row["foot"], row["axis"], row["name"]) == ("left", "pitch", "stiffness"):
            row["std"] = None
        if (row["foot"], row["axis"], row["name"]) == ("right", "roll", "damping"):
            row["std"] = row["interval95"] = None
    notes = export(feet, "randomization", tmp_path / "r.yaml")
    unknown = [note.text for note in notes if note.code == "export_spread"]
    assert len(unknown) == 1
    assert unknown[0].startswith("right.roll.damping")
    made, place = ranges(feet, tmp_path)
    assert made["parameters"][place["left.pitch.stiffness"]]["std"] == pytest.approx(480 * 0.04 / 3.92)


@pytest.mark.parametrize("value", [9.5, -2.5])
def test_a_range_is_as_wide_as_the_logs_leave_it(value: float, feet: dict[str, Any], tmp_path: Path) -> None:
    row = feet["parameters"][3]
    assert (row["axis"], row["name"]) == ("pitch", "damping")
    row.update(value=value, std=11.0, interval95=[-12.0, 31.0], verdict="unidentifiable")
    made, place = ranges(feet, tmp_path)
    found = made["parameters"][place["left.pitch.damping"]]
    assert (found["mean"], found["std"], found["above"]) == pytest.approx((value, 11.0, 0.0))


def test_offsets_hold_what_no_recording_shows(feet: dict[str, Any], tmp_path: Path) -> None:
    """A lean of the IMU by its mount's deviation moves each offset by K times that, all of one axis together."""
    feet["robot_model"]["uncertainty"] = {"imu_mount": 0.02, "encoder_zero": 0.0}
    made, place = ranges(feet, tmp_path)
    scatter = np.std([-0.5, 0.5], ddof=1)
    for foot in ("left", "right"):
        k = TRUTH[foot]["pitch"][0]
        found = made["parameters"][place[f"{foot}.pitch.offset"]]
        assert found["std"] == pytest.approx(np.hypot(scatter, 0.02 * k))
    both = made["correlation"][place["left.pitch.offset"]][place["right.pitch.offset"]]
    leans = [0.02 * TRUTH[foot]["pitch"][0] for foot in ("left", "right")]
    assert both == pytest.approx(np.prod([lean / np.hypot(scatter, lean) for lean in leans]), abs=1e-4)
    assert made["correlation"][place["left.pitch.offset"]][place["left.roll.offset"]] == 0
    feet["robot_model"]["uncertainty"] = {"imu_mount": 0.0, "encoder_zero": 0.0}
    made, place = ranges(feet, tmp_path)
    assert made["parameters"][place["left.pitch.offset"]]["std"] == pytest.approx(scatter)
    feet["robot_model"]["uncertainty"] = {"imu_mount": 0.0, "encoder_zero": 0.01}
    made, place = ranges(feet, tmp_path)
    leans = np.sqrt(6) * 0.01 * TRUTH["left"]["pitch"][0]  # six joints, each with a zero of its own
    assert made["parameters"][place["left.pitch.offset"]]["std"] == pytest.approx(np.hypot(scatter, leans))


def test_offsets_that_agree_are_as_sure_as_the_surest(feet: dict[str, Any], tmp_path: Path) -> None:
    feet["robot_model"]["uncertainty"] = {"imu_mount": 0.0, "encoder_zero": 0.0}
    own = [row for row in feet["offsets"] if (row["foot"], row["axis"]) == ("left", "pitch")]
    for row, std in zip(own, (0.3, 0.1), strict=True):
        row |= {"value": 2.0, "std": std}
    made, place = ranges(feet, tmp_path)
    found = made["parameters"][place["left.pitch.offset"]]
    assert (found["mean"], found["std"]) == pytest.approx((2.0, 0.1))


def test_a_vertical_stiffness_that_only_the_sum_shows_is_one_number(
    feet: dict[str, Any], tmp_path: Path
) -> None:
    for row in [row for row in feet["parameters"] if row["foot"] == "left" and row["axis"] == "z"]:
        feet["parameters"].append({**row, "foot": "right"})
    name = "left.z.stiffness", "right.z.stiffness"
    made, place = ranges(feet, tmp_path)
    assert made["correlation"][place[name[0]]][place[name[1]]] == 0
    feet["notes"] = [{"code": "z_alone", "severity": "info", "text": "each foot"}]
    made, place = ranges(feet, tmp_path)
    assert made["correlation"][place[name[0]]][place[name[1]]] == 0
    feet["notes"] = [{"code": "z_sum_only", "severity": "info", "text": "only the sum"}]
    made, place = ranges(feet, tmp_path)
    assert made["correlation"][place[name[0]]][place[name[1]]] == 1


def test_the_page_sets_the_friction_that_contacts_have(feet: dict[str, Any], tmp_path: Path) -> None:
    """In a model whose feet have a friction of their own, which is larger than any that is drawn."""
    mujoco = pytest.importorskip("mujoco")
    export(feet, "mjcf", tmp_path / "robot.xml")
    page = ROOT / "docs" / "how_to" / "randomisation.md"
    line = next(
        row
        for block in blocks(page)
        for row in block.text.splitlines()
        if "friction[" in row and " = " in row
    )
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "robot.xml"))
    assert model.geom_friction[:, 0].max() == 1.0
    exec(line, {"model": model, "random": np.random.default_rng(0), "low": 0.4, "high": 0.5})
    data = mujoco.MjData(model)
    for _ in range(50):
        mujoco.mj_step(model, data)
    assert data.ncon > 0
    assert all(0.4 <= contact.friction[0] <= 0.5 for contact in data.contact)


def snippets(*names: str) -> str:
    """The page's blocks of Python, up to the last that defines one of these functions."""
    texts = [block.text for block in blocks(ROOT / "docs/how_to/randomisation.md") if block.kind == "python"]
    return "\n".join(
        texts[: 1 + max(i for i, text in enumerate(texts) for name in names if f"def {name}(" in text)]
    )


def test_the_pages_function_for_playground_draws_in_mjx(feet: dict[str, Any], tmp_path: Path) -> None:
    python = other_python("PLANTAR_MJX_PYTHON", "mujoco.mjx")
    ranges(feet, tmp_path)
    export(feet, "mjcf", tmp_path / "robot_on_bushes.xml")
    program = (
        snippets("domain_randomize")
        + """
import json
import jax
from mujoco import mjx
randomized, rows = domain_randomize(mjx.put_model(model), jax.random.split(jax.random.PRNGKey(0), 2000))
assert rows.jnt_stiffness == rows.dof_damping == rows.geom_friction == 0 and rows.body_mass is None
joint = model.joint("LLEG_BUSH_PITCH")
found = [randomized.jnt_stiffness[:, joint.id], randomized.dof_damping[:, joint.dofadr[0]],
         randomized.jnt_stiffness[:, model.joint("LLEG_BUSH_ROLL").id], randomized.geom_friction[:, 0, 0]]
print("\\n" + json.dumps(np.array(found, float).tolist()))
"""
    )
    done = subprocess.run([python, "-c", program], capture_output=True, text=True, cwd=tmp_path, timeout=200)
    assert done.returncode == 0, done.stderr[-2000:]
    k, c, roll, friction = np.array(json.loads(done.stdout.splitlines()[-1]))
    assert (k.mean(), k.std()) == pytest.approx((480, 4.8), rel=0.06)
    assert (c.mean(), c.std()) == pytest.approx((24.27, 0.2427), rel=0.06)
    assert np.corrcoef(k, roll)[0, 1] == pytest.approx(0.36, abs=0.06), "one force sensor's gain"
    assert 0.4 <= friction.min() < 0.41
    assert 0.99 < friction.max() <= 1


def test_the_pages_event_term_writes_correlated_feet(feet: dict[str, Any], tmp_path: Path) -> None:
    """On an articulation that keeps what it is given, by the names and arguments of Isaac Lab's."""
    python = other_python("PLANTAR_TORCH_PYTHON", "torch, yaml")
    ranges(feet, tmp_path)
    text = snippets("draw_feet")
    text = "import numpy as np\nimport yaml\n" + text[text.index("def draw_feet(") :]
    program = (
        text
        + """
import json
import torch

class Robot:
    device = "cpu"
    def __init__(self): self.names, self.kept = [], {}
    def find_joints(self, name_keys, joint_subset=None, preserve_order=False):
        self.names += [name_keys] if name_keys not in self.names else []
        return [self.names.index(name_keys)], [name_keys]
    def write_joint_stiffness_to_sim(self, stiffness, joint_ids=None, env_ids=None):
        assert stiffness.shape == (len(env_ids), len(joint_ids))
        self.kept["K", self.names[joint_ids[0]]] = stiffness[:, 0]
    def write_joint_damping_to_sim(self, damping, joint_ids=None, env_ids=None):
        assert damping.shape == (len(env_ids), len(joint_ids))
        self.kept["C", self.names[joint_ids[0]]] = damping[:, 0]

class Env:
    num_envs, scene = 4000, {"robot": Robot()}

draw_feet(Env, torch.arange(2000), "ranges.yaml")
kept = Env.scene["robot"].kept
pitch, roll = (kept["K", f"LLEG_BUSH_{axis}"].tolist() for axis in ("PITCH", "ROLL"))
print("\\n" + json.dumps([len(kept), pitch, roll]))
"""
    )
    done = subprocess.run([python, "-c", program], capture_output=True, text=True, cwd=tmp_path, timeout=200)
    assert done.returncode == 0, done.stderr[-2000:]
    count, pitch, roll = json.loads(done.stdout.splitlines()[-1])
    assert count == 10
    assert (np.mean(pitch), np.std(pitch)) == pytest.approx((480, 4.8), rel=0.06)
    assert np.corrcoef(pitch, roll)[0, 1] == pytest.approx(0.36, abs=0.06)


def test_a_number_that_is_zero_is_spread_as_if_nothing_were_known(
    feet: dict[str, Any], tmp_path: Path
) -> None:
    feet["parameters"].append(
        feet["parameters"][2] | {"name": "cubic_stiffness", "unit": "N.m/rad3", "value": 0.0}
    )
    made, _ = ranges(feet, tmp_path)
    assert all(np.isfinite(row["std"]) for row in made["parameters"])

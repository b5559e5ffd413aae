"""What exports write and say, by value: springs at their limits, the small text targets whole, ranges to train with."""

from __future__ import annotations

import copy
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from export_robots import TRUTH
from plantar.conventions import Axis
from plantar.errors import ExportError
from plantar.exporters import export
from plantar.exporters.bush import FootBush, check_swing, raised
from plantar.exporters.shapes import plate, reaches_sole
from plantar.exporters.spring import Slip, Spring, spring_of
from plantar.exporters.urdf import geometry
from plantar.exporters.urdf.geometry import mesh_points
from plantar.exporters.xml_file import vector
from plantar.notes import Notes

OUTLINE = np.array([[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]])


def foot(depth: float = 0.04) -> FootBush:
    sole = np.column_stack([OUTLINE, np.full(4, -depth)])
    return FootBush("left", "ankle", (Spring("pitch", 400.0, 20.0, 4.0),), np.zeros(3), np.eye(3), sole)


def row(name: str, value: float | None, verdict: str = "usable", **more: object) -> dict[str, Any]:
    return {
        "foot": "left",
        "axis": "pitch",
        "name": name,
        "value": value,
        "verdict": verdict,
        "unit": {"stiffness": "N.m/rad", "damping": "N.m.s/rad"}.get(name, "N.m"),
    } | more


def sprung(
    *rows: dict[str, Any], axis: Axis = "pitch", result: dict[str, Any] | None = None, **options: Any
) -> Any:
    """The spring and what was said of it."""
    notes = Notes()
    made = spring_of(
        result or {}, list(rows), "left", axis, options.pop("with_offset", False), notes, **options
    )
    return made, [note.text for note in notes]


K = row("stiffness", 400.0)


@pytest.mark.parametrize(
    ("damping", "written", "assumed", "said"),
    [
        (row("damping", 20.0), 20.0, False, []),
        (row("damping", None), 0.8, True, ["no damping identified; exported as K x 2 ms, for stable simulators"]),
        (row("damping", 0.0), 0.8, True, ["the identified damping 0 is not positive, and a foot would never come to "
                                          "rest; exported as K x 2 ms"]),
        (row("damping", 5.0, "weak", interval95=[3.0, 7.0]), 5.0, False,
         ["the damping is weak (5, 95 % from 3 to 7 N·m·s/rad)"]),
        (row("damping", 5.0, "unidentifiable", interval95=[-3.0, 7.0]), 0.8, True,
         ["the damping is unidentifiable (5, 95 % from -3 to 7 N·m·s/rad); exported as K x 2 ms = 0.8"]),
        (row("damping", 5.0, "unidentifiable", interval95=[0.81, 7.0]), 0.81, True,
         ["the damping is unidentifiable (5, 95 % from 0.81 to 7 N·m·s/rad); exported as the low end = 0.81"]),
        (row("damping", 0.5, "unidentifiable", interval95=[-1.0, 0.79]), 0.79, True,
         ["the damping is unidentifiable (0.5, 95 % from -1 to 0.79 N·m·s/rad); exported as the high end = 0.79"]),
        (row("damping", -5.0, "unidentifiable", interval95=[-7.0, -1.0]), 0.8, True,
         ["the damping is unidentifiable (-5, 95 % from -7 to -1 N·m·s/rad); exported as K x 2 ms = 0.8"]),
    ],
)  # fmt: skip
def test_a_damping_that_logs_do_not_show(
    damping: dict[str, Any], written: float, assumed: bool, said: list[str]
) -> None:
    made, notes = sprung(K, damping)
    assert (made.damping, made.assumed) == (pytest.approx(written), assumed)
    assert notes == [f"left pitch: {text}" for text in said]


def test_a_stiffness_that_is_not_known_or_not_positive() -> None:
    assert sprung(row("stiffness", None)) == (None, [])
    z = row("stiffness", 4e4, "unidentifiable") | {"axis": "z"}
    assert sprung(z, axis="z") == (None, []), "what hardly gives looks like any large number"
    made, notes = sprung(row("stiffness", 400.0, "unidentifiable"), row("damping", 20.0))
    assert (made.stiffness, notes) == (400.0, ["left pitch: the stiffness is unidentifiable"])
    for value in (0.0, -1.0, float("nan"), "many"):
        with pytest.raises(ExportError):
            sprung(row("stiffness", value))  # type: ignore[arg-type]


SLIPS = (K, row("damping", 20.0), row("slip_torque", 4.0), row("slip_angle", 0.01))


@pytest.mark.parametrize(("swing", "stiffness", "lost"), [(0.01, 400.0, 0.0), (0.02, 200.0, 0.16)])
def test_a_slip_becomes_spring_and_damper_of_a_swing(swing: float, stiffness: float, lost: float) -> None:
    """4 N·m after 0.01 rad: up to there a spring of 400; at twice as much half of it, and a loop of 4·4·0.01 J."""
    slip = Slip(4.0, 0.01)
    assert slip.stiffness_at(swing) == pytest.approx(stiffness)
    assert slip.damping_at(swing) == pytest.approx(lost / (np.pi * 3.0 * swing**2))
    made, notes = sprung(*SLIPS, swing=swing)
    assert (made.stiffness, made.damping) == pytest.approx((400 + stiffness, 20 + slip.damping_at(swing)))
    assert notes == [
        f"left pitch: the slip is written as the spring and damper of swings of {swing:g} rad at 3 rad/s"
    ]


def test_a_slip_goes_along_where_the_target_holds_one_and_else_the_nearest_spring_does() -> None:
    made, notes = sprung(*SLIPS, hysteresis=True)
    assert (made.slip, made.stiffness, notes) == (Slip(4.0, 0.01), 400.0, [])
    left = "left pitch: the target holds a linear spring and damper; left out: slip_torque, slip_angle"
    assert sprung(*SLIPS)[1] == [left]
    law = {"foot": "left", "axis": "pitch", "linear_equivalent": {"stiffness": 500.0, "damping": 30.0}}
    made, notes = sprung(*SLIPS, result={"laws": [law]})
    assert (made.stiffness, made.damping, made.assumed) == (500.0, 30.0, False)
    assert notes == [f"{left}; K and C are those of the spring and damper nearest to the identified motions"]
    for at in (0.0, -1.0):  # no slip at all
        assert sprung(*SLIPS[:2], row("slip_torque", at), SLIPS[3], swing=0.01)[0].stiffness == 400.0
    broken = {**law, "linear_equivalent": {"stiffness": 500.0, "damping": 0.0}}
    assert sprung(*SLIPS, result={"laws": [broken]})[0].stiffness == 400.0


def test_a_slip_becomes_that_of_the_swing_in_the_middle_of_the_identified_motions() -> None:
    """Swings of 8, 12 and 50 mrad, whose torques have means of 2/π of their amplitudes; other axes' do not count."""
    law = {"foot": "left", "axis": "pitch", "linear_equivalent": {"stiffness": 500.0, "damping": 30.0}}
    scores = [
        {"kind": kind, "foot": "left", "axis": axis, "zero_mean_abs": 500.0 * swing * 2 / np.pi}
        for kind, axis, swing in (("direct", "pitch", 0.008), ("direct", "pitch", 0.05), ("direct", "pitch", 0.012),
                                  ("cross", "pitch", 0.2), ("direct", "roll", 0.2))
    ]  # fmt: skip
    made, notes = sprung(*SLIPS, result={"laws": [law], "validation": scores})
    chosen, _ = sprung(*SLIPS, swing=0.012)
    assert (made.stiffness, made.damping) == pytest.approx((chosen.stiffness, chosen.damping))
    assert notes == [
        "left pitch: the slip is written as the spring and damper of swings of 0.012 rad at 3 rad/s, the middle of the "
        "identified motions; for others give --swing"
    ]
    kept, _ = sprung(*SLIPS, result={"laws": [law], "validation": scores}, hysteresis=True)
    assert (kept.stiffness, kept.slip) == (400.0, Slip(4.0, 0.01))
    alone, _ = sprung(*SLIPS, result={"validation": scores})
    assert alone.stiffness == 400.0, "no stiffness to make an angle of"


@pytest.mark.parametrize(("swing", "taken"), [(0.0, False), (1e-3, True), (0.999, True), (1.001, False)])
def test_the_motions_show_no_swing_where_they_have_none_or_more_than_a_radian(
    swing: float, taken: bool
) -> None:
    law = {"foot": "left", "axis": "pitch", "linear_equivalent": {"stiffness": 500.0, "damping": 30.0}}
    mean = 500.0 * swing * 2 / np.pi
    scores = [{"kind": "direct", "foot": "left", "axis": "pitch", "zero_mean_abs": mean}]
    made, _ = sprung(*SLIPS, result={"laws": [law], "validation": scores})
    wanted = sprung(*SLIPS, swing=swing)[0].stiffness if taken else 500.0
    assert made.stiffness == pytest.approx(wanted)


def test_a_sole_rests_where_its_springs_do_and_is_not_turned_about_an_axis_without_one() -> None:
    lean, roll = 0.01, Spring("roll", 300.0, 10.0, -6.0)
    pitched = np.array([[np.cos(lean), 0, -np.sin(lean)], [0, 1, 0], [np.sin(lean), 0, np.cos(lean)]])
    assert foot().turn_at_rest == pytest.approx(pitched, abs=1e-12)
    rolled = replace(foot(), springs=(roll, Spring("z", 4e4, 400.0, 20.0))).turn_at_rest
    assert rolled[:, 0] == pytest.approx([1.0, 0.0, 0.0])
    assert rolled[2, 1] == pytest.approx(np.sin(0.02))
    both = replace(foot(), springs=(*foot().springs, roll)).turn_at_rest
    assert both == pytest.approx(pitched @ rolled)


def test_an_offset_is_the_mean_of_the_motions() -> None:
    offsets = [{"foot": "left", "axis": "pitch", "value": value} for value in (1.0, 2.0, 6.0)]
    made, notes = sprung(K, row("damping", 20.0), result={"offsets": offsets}, with_offset=True)
    assert (made.offset, made.rest) == (3.0, pytest.approx(-3 / 400))
    assert notes == ["left pitch: offset 3, the mean of 3 motions from 1 to 6"]
    assert sprung(K, row("damping", 20.0), result={"offsets": offsets})[0].offset == 0.0
    assert sprung(K, row("damping", 20.0), result={"offsets": offsets[:1]}, with_offset=True)[1] == []


@pytest.mark.parametrize(
    ("swing", "valid"), [(None, True), (0.001, True), (0.999, True), (0.0, False), (1.0, False)]
)
def test_a_swing_is_an_angle_of_a_foot(swing: float | None, valid: bool) -> None:
    if valid:
        check_swing(swing)
    else:
        with pytest.raises(ExportError, match="above 0, below 1 rad"):
            check_swing(swing)


@pytest.mark.parametrize(
    ("depth", "height", "reaches"),
    [(0.04, -0.0199, False), (0.04, -0.0201, True), (0.008, -0.0029, False), (0.008, -0.0031, True)],
)
def test_a_shape_reaches_the_sole_from_half_way_on(depth: float, height: float, reaches: bool) -> None:
    """Or from 5 mm above it where the bush is that low."""
    assert reaches_sole(np.array([[0.0, 0.0, height], [0.0, 0.0, 0.1]]), foot(depth)) == reaches


def test_a_plate_and_frames_under_the_bush() -> None:
    size, centre = plate(foot())
    assert size == pytest.approx([0.2, 0.1, 0.01])
    assert centre == pytest.approx([0.0, 0.0, -0.035])
    assert foot().sole_depth == pytest.approx(0.04)
    assert [foot().below(np.array([0, 0, z])) for z in (-0.9e-4, -1.1e-4)] == [False, True]
    assert raised(foot()).sole_depth == pytest.approx(0.0)
    assert [foot(0.0005).below(np.array([0, 0, z])) for z in (0.0006, 0.0004)] == [False, True]


def comments(text: str) -> list[str]:
    return [line[2:] for line in text.splitlines() if line.startswith("# ")]


def written(feet: dict[str, Any], target: str, folder: Path, **options: Any) -> tuple[str, dict[str, str]]:
    notes = export(feet, target, folder / "out", **options)
    return (folder / "out").read_text(), {note.code: note.severity for note in notes}


def test_choreonoid_has_means_and_openhrp_each_joint(feet: dict[str, Any], tmp_path: Path) -> None:
    hinges = [TRUTH[side][axis] for side in ("left", "right") for axis in ("pitch", "roll")]
    text, codes = written(feet, "choreonoid", tmp_path)
    assert yaml.safe_load(text) == {
        "bush": {"springT": 40000.0, "dampingT": 400.0, "springR": pytest.approx(np.mean([k for k, _, _ in hinges])),
                 "dampingR": pytest.approx(np.mean([c for _, c, _ in hinges]))},
    }  # fmt: skip
    assert comments(text)[:2] == ["Feet of 'biped', identified by plantar 0.1.0,", "for Choreonoid."]
    assert codes == {"export_rigid": "info", "export_mean": "warning"}
    flat = copy.deepcopy(feet)
    flat["parameters"] = [row for row in flat["parameters"] if row["axis"] != "z"]
    notes = export(flat, "choreonoid", tmp_path / "flat")
    assert "springT" not in yaml.safe_load((tmp_path / "flat").read_text())["bush"]
    assert any(note.text.startswith("z is not identified: springT and dampingT are left") for note in notes)
    text, codes = written(feet, "choreonoid", tmp_path, with_offset=True)
    assert "rests at -offset" not in text, "hinges without a rest position"
    assert codes["export_offset"] == "warning"
    text, codes = written(feet, "openhrp", tmp_path, with_offset=True)
    config = dict(line.split(": ", 1) for line in text.splitlines() if not line.startswith("#"))
    assert config["robot_model_name"] == "biped"
    assert config["bush_config"] == (
        "LLEG_BUSH_Z,40000,400 LLEG_BUSH_ROLL,352,28.15 LLEG_BUSH_PITCH,480,24.27 "
        "RLEG_BUSH_ROLL,323,17.53 RLEG_BUSH_PITCH,434,15.89"
    )
    assert comments(text)[1] == "for the bush customizer."
    assert codes["export_offset"] in ("info", "warning")
    assert "export_joints" not in codes


def test_the_observer_and_mc_rtc_have_their_own_entries(feet: dict[str, Any], tmp_path: Path) -> None:
    text, codes = written(feet, "kinetics_observer", tmp_path)
    assert yaml.safe_load(text) == {
        "linStiffness": [40000.0, 40000.0, 40000.0], "angStiffness": [(352 + 323) / 2, (480 + 434) / 2, 400.0],
        "linDamping": [120.0, 120.0, 400.0], "angDamping": [(28.15 + 17.53) / 2, (24.27 + 15.89) / 2, 12.0],
    }  # fmt: skip
    assert comments(text)[1] == "for the Kinetics Observer."
    assert codes == {
        "export_rigid": "info", "export_mean": "warning", "export_default": "warning", "export_world": "info",
    }  # fmt: skip
    text, codes = written(feet, "mc_rtc", tmp_path, with_offset=True)
    content = json.loads(text)
    assert {entry["jointName"]: (entry["K"], entry["C"], entry["O"]) for entry in content["flexibilities"]} == {
        f"{leg}_BUSH_{axis.upper()}": pytest.approx(values)
        for leg, side in (("LLEG", "left"), ("RLEG", "right")) for axis, values in TRUTH[side].items()
    }  # fmt: skip
    assert content["plantar"][1] == "for mc_rtc."
    assert codes == {"export_rigid": "info", "export_offset": "info", "export_mc_rtc": "info"}


@pytest.mark.parametrize(("target", "named"), [("urdf", True), ("usd", True), ("sdf", True), ("yaml", False)])
def test_bush_joints_are_named_where_there_are_any(
    target: str, named: bool, feet: dict[str, Any], tmp_path: Path
) -> None:
    text, codes = written(feet, target, tmp_path)
    assert ("export_joints" in codes) == named
    assert "identified by plantar 0.1.0" in text
    if target == "usd":
        assert "#usda 1.0" in text
        assert 'def Xform "left' in text
        assert text.count("float physics:mass = 0.05") == 7  # five links on two ankles
        assert text.count("quatd xformOp:orient = ") >= 7


def test_ranges_to_train_with(feet: dict[str, Any], tmp_path: Path) -> None:
    """Offsets scatter by their motions and by what a turned IMU and six encoders' zeros make of the stiffness."""
    feet["robot_model"]["uncertainty"] = {"imu_mount": 0.003, "encoder_zero": 0.0005}
    feet["parameters"][0] |= {"std": None}  # left z stiffness: of its interval
    feet["parameters"][3] |= {"std": None, "interval95": None}  # left pitch damping: nothing is known
    text, codes = written(feet, "randomization", tmp_path)
    made = yaml.safe_load(text)
    rows = {one["name"]: one for one in made["parameters"]}
    assert comments(text)[1] == "for training."
    assert comments(text)[-1] == "parameters are jointly normal: mean, std and, in their order, correlation."
    assert made["schema"] == "plantar.randomization/1"
    assert made["independent"] == [{"name": "friction", "unit": "1", "distribution": "uniform", "low": 0.4, "high": 1.0,
                                    "measured": False}]  # fmt: skip
    assert codes["export_friction"] == "warning"
    assert codes["export_spread"] == "warning"
    assert rows["left.z.stiffness"]["std"] == pytest.approx(0.04 * 40000 / 3.92)
    assert rows["left.pitch.damping"]["std"] == 0.0
    for name, k in (("left.pitch", 480.0), ("right.roll", 323.0)):
        scatter = np.std([-0.5, 0.5], ddof=1)
        lean = np.sqrt(0.003**2 + 6 * 0.0005**2)
        assert rows[f"{name}.offset"]["std"] == pytest.approx(np.hypot(scatter, k * lean))
    places = {one["name"]: place for place, one in enumerate(made["parameters"])}
    matrix = np.array(made["correlation"])
    own = [k * 0.003 / rows[f"{side}.pitch.offset"]["std"] for side, k in (("left", 480.0), ("right", 434.0))]
    between = matrix[places["left.pitch.offset"], places["right.pitch.offset"]]
    assert between == pytest.approx(own[0] * own[1], abs=6e-5), "to four digits"
    assert between == round(between, 4)


@pytest.mark.parametrize("text", ["a", "1 2", "nan", "1,2", "1 b"])
def test_an_attribute_that_is_not_so_many_numbers_is_refused(text: str) -> None:
    """Of any count, one as well."""
    for size in (1, 3):
        with pytest.raises(ExportError, match=f"mass is not {size} numbers"):
            vector(text, size, "mass")
    assert vector(" 3 ", 1, "mass") == [3.0]
    assert vector(None, 3, "axis", 1.0).tolist() == [1.0, 1.0, 1.0]


def test_a_mesh_is_read_where_there_is_one_that_is_not_too_large(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "sole.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    found = mesh_points(path, np.array([2.0, 3.0, 1.0]))
    assert found is not None
    np.testing.assert_allclose(np.ptp(found, axis=0), [2.0, 3.0, 0.0])
    for none in (None, tmp_path, tmp_path / "nowhere.obj"):
        assert mesh_points(none, np.ones(3)) is None
    for limit, read in ((path.stat().st_size, True), (path.stat().st_size - 1, False)):
        monkeypatch.setattr(geometry, "MESH_LIMIT", limit)
        assert (mesh_points(path, np.ones(3)) is not None) == read

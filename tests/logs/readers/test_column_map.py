"""Foreign columns: what a map or a port may get wrong."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from biped_robot import make_robot
from plantar.errors import LogError
from plantar.logs.readers import open_log, text_numbers
from plantar.logs.readers.column_map import apply
from plantar.robot.model import RobotModel


@pytest.mark.parametrize(
    ("columns", "expected"),
    [
        ({"joint.neck.position": {"from": "nick", "unit": "deg"}}, "neck_deg"),
        ({"joint.neck.position": {"from": "neck_deg", "unit": "N"}}, "deg"),
        (
            {"joint.neck.angle": "neck_deg"},
            r"robot\.yaml: columns\.joint\.neck\.angle is no column of plantar \(valid: time, "
            r"joint\.<joint>\.position, imu\.<name>\.angular_velocity, wrench\.<name>\.force, "
            r"\.\.\.\)$",
        ),
        ({"imu.chest.orientation": {"from": ["neck_deg"] * 4, "order": "zyxw"}}, "wxyz"),
        (
            {"wrench.left.force": ["neck_deg"]},
            r"robot\.yaml, value 1: columns\.wrench\.left\.force needs three sources$",
        ),
        (
            {"joint.neck.position": {"from": "neck_deg", "sign": 2}},
            r"robot\.yaml, value '2': columns\.joint\.neck\.position: sign \(valid: 1 or -1\)$",
        ),
        ({"joint.neck.position": {"of": "neck_deg"}}, "from"),
        (
            {"joint.neck.position": 7},
            r"log\.csv: columns\.joint\.neck\.position: no column 7 \(valid: 0 to 1\)$",
        ),
        (
            {"joint.<joint>.position": {"from": "<joint>_rad"}},
            r"robot\.yaml: columns\.joint\.<joint>\.position: no column is called like '<joint>_rad' "
            r"\(valid: time, neck_deg\)$",
        ),
        (
            {"joint.<joint>.position": "neck_deg"},
            r"robot\.yaml: columns\.joint\.<joint>\.position needs one <joint> here and there "
            r"\(valid: joint\.<joint>\.position: \{from: <joint>_angle, unit: deg\}\)$",
        ),
        ({"joint.neck.position": "<joint>_deg"}, "<joint>_deg"),
    ],
)
def test_a_map_that_cannot_hold_is_one_clear_line(
    columns: dict[str, object], expected: str, tmp_path: Path
) -> None:
    (tmp_path / "log.csv").write_text("time,neck_deg\n0,1\n1,2\n2,3\n")
    robot = make_robot(tmp_path / "robot", columns=columns)
    with pytest.raises(LogError, match=expected) as caught:
        open_log(tmp_path / "log.csv", robot)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("columns", "where"),
    [
        (
            {"joints": ["a", "b", "a"]},
            r"robot\.yaml, value 'a': columns\.joints names a joint twice \(valid: each joint once\)$",
        ),
        (
            {"ports": {"sh_q": {"role": "joints.position", "joints": ["b", "b", "a"]}}},
            r"robot\.yaml, value 'b': columns\.ports\.sh_q\.joints names a joint twice \(valid: each "
            r"joint once\)$",
        ),
    ],
)
def test_a_joint_that_is_named_twice_is_refused(
    columns: dict[str, object], where: str, tmp_path: Path
) -> None:
    (tmp_path / "walk.sh_q").write_text("0.0 1 2 3\n0.1 1 2 3\n0.2 1 2 3\n")
    with pytest.raises(LogError, match=where):
        open_log(tmp_path / "walk.sh_q", make_robot(tmp_path / "robot", columns=columns))


@pytest.mark.parametrize("cell", ["--", ""])
def test_a_column_that_is_there_but_holds_no_numbers_is_not_called_missing_alone(
    cell: str, tmp_path: Path
) -> None:
    (tmp_path / "log.csv").write_text(f"time,neck_deg,hip_deg\n0,{cell},1\n1,{cell},2\n2,{cell},3\n")
    robot = make_robot(tmp_path / "robot", columns={"joint.neck.position": "neck_deg"})
    with pytest.raises(LogError, match=r"'neck_deg': is missing, or holds a text or nothing \(columns"):
        open_log(tmp_path / "log.csv", robot)


def test_one_line_maps_the_columns_of_all_joints(tmp_path: Path) -> None:
    """A joint with a line of its own keeps it; a column without a joint's name is none."""
    (tmp_path / "log.csv").write_text("time,q_neck,q_waist,q_,other\n0,180,9,9,9\n1,90,9,9,9\n2,0,9,9,9\n")
    columns = {
        "joint.<joint>.position": {"from": "q_<joint>", "unit": "deg"},
        "joint.waist.position": "q_waist",
    }
    log = open_log(tmp_path / "log.csv", make_robot(tmp_path / "robot", columns=columns))
    assert list(log.columns) == ["joint.neck.position", "joint.waist.position"]
    np.testing.assert_allclose(log.columns["joint.neck.position"], [np.pi, np.pi / 2, 0])
    np.testing.assert_array_equal(log.columns["joint.waist.position"], 9)


def test_a_joint_vector_of_another_length_or_without_names_is_refused(tmp_path: Path) -> None:
    (tmp_path / "walk.sh_q").write_text("0.0 1 2 3\n0.1 1 2 3\n0.2 1 2 3\n")
    with pytest.raises(
        LogError,
        match=r"walk\.sh_q: does not name its 3 joints \(valid: columns\.joints in the robot file, in "
        r"the log's order\)$",
    ):
        open_log(tmp_path / "walk.sh_q")
    robot = make_robot(tmp_path / "robot", columns={"joints": ["neck"]})
    with pytest.raises(
        LogError,
        match=r"walk\.sh_q: joints\.position: the log has 3 values a sample, not 1 \(valid: "
        r"columns\.joints in the robot file, in the log's order\)$",
    ):
        open_log(tmp_path / "walk.sh_q", robot)


def test_a_text_log_with_broken_lines_keeps_the_good_ones(tmp_path: Path) -> None:
    lines = [f"{0.01 * i:.2f} {i}" for i in range(400)]
    lines[200] = "2.00 oops"
    (tmp_path / "walk.sh_q").write_text("\n".join(lines) + "\n4.0")
    log = open_log(tmp_path / "walk.sh_q", make_robot(tmp_path / "robot", columns={"joints": ["neck"]}))
    assert len(log) == 399
    assert {"lines_broken", "file_cut"} <= {note.code for note in log.notes}


words = st.sampled_from([
    "time", "a", "joint.neck.position", "imu.chest.orientation", "wrench.left.force", "joints", "ports", "from", "unit",
    "joint.<joint>.position", "<joint>", "order", "sign", "deg", "N", "wxyz", "rpy", "role", "joints.position", "take",
    "",
])  # fmt: skip
scalars = st.none() | st.booleans() | st.integers(-3, 5) | st.floats(allow_nan=False) | words
trees = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(words, inner, max_size=4),
    max_leaves=8,
)


def refusal(path: Path, robot: RobotModel) -> str:
    """Why a log is refused, or nothing."""
    try:
        open_log(path, robot)
    except LogError as error:
        return str(error)
    return ""


@given(columns=st.dictionaries(words.filter(bool), trees, max_size=4))
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_whatever_stands_in_columns(columns: dict[str, object], tmp_path: Path, robot: RobotModel) -> None:
    """A log or one line, never anything else."""
    (tmp_path / "log.csv").write_text("time,a\n0,1\n1,2\n2,3\n")
    (tmp_path / "log.sh_q").write_text("0 1\n1 2\n2 3\n")
    for name in ("log.csv", "log.sh_q"):
        assert "\n" not in refusal(tmp_path / name, replace(robot, columns=columns))


def test_units_and_signs_of_a_map_are_taken(tmp_path: Path) -> None:
    columns = {
        "time": {"from": "t", "unit": "ms"},
        "joint.neck.position": {"from": "neck", "unit": "deg", "sign": -1},
        "imu.chest.angular_velocity": {"from": ["x", "y", "z"], "unit": "deg/s", "sign": -1},
    }
    robot = make_robot(tmp_path, columns=columns)
    values = np.arange(1.0, 11.0)
    table = {"t": 5.0 * values, "neck": values, "x": values, "y": 2 * values, "z": 3 * values}
    time, found = apply(table, robot, tmp_path / "log.csv")
    np.testing.assert_allclose(time, 0.005 * values)
    np.testing.assert_allclose(found["joint.neck.position"], -np.radians(values))
    for place, axis in enumerate("xyz", start=1):
        np.testing.assert_allclose(found[f"imu.chest.angular_velocity.{axis}"], -np.radians(place * values))


def test_arrays_of_an_npz_that_are_no_columns_are_left_out(tmp_path: Path) -> None:
    """A gain, a list of settings or a transposed table beside the recording."""
    time = np.arange(5.0)
    np.savez(
        tmp_path / "log.npz", time=time, gains=np.ones(7), wide=np.ones((3, 9)), **{"joint.a.position": time}
    )
    log = open_log(tmp_path / "log.npz")
    assert list(log.columns) == ["joint.a.position"]
    (note,) = [one for one in log.notes if one.code == "array_length"]
    assert note.text.startswith(
        "log.npz: not of 5 samples as the recording has, left out: gains (7), wide.0 (3)"
    )


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("time;joint.a.position\n0,0;1,5\n0,1;1,25e-2\n", "0,0;1,5"),
        ("0,0 1,5 7\n0,1 1,6 7\n", "0,0 1,5 7"),
        ("0\t1\n1\t1,6\n", "1 1,6"),
    ],
)
def test_decimal_commas_are_named(text: str, shown: str, tmp_path: Path) -> None:
    (tmp_path / "log.txt").write_text(text)
    with pytest.raises(LogError, match="has decimal commas") as caught:
        open_log(tmp_path / "log.txt")
    assert f"'{shown}' (valid: decimal points)" in str(caught.value)


@pytest.mark.parametrize(
    "text", ["time,joint.a.position\n0,1\n1,2\n", "time, joint.a.position\n0, 1\n1, 2\n"]
)
def test_commas_between_whole_numbers_part_them(text: str, tmp_path: Path) -> None:
    (tmp_path / "log.txt").write_text(text)
    np.testing.assert_array_equal(open_log(tmp_path / "log.txt").column("joint.a.position"), [1.0, 2.0])


def test_a_file_that_cannot_be_opened_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    (tmp_path / "log.txt").write_text("time,joint.a.position\n0,1\n1,2\n")
    monkeypatch.setattr(text_numbers, "open", refuse, raising=False)
    with pytest.raises(LogError, match=r"log\.txt: cannot be read: Permission denied"):
        open_log(tmp_path / "log.txt")


@pytest.mark.parametrize("mark", [";", "\t"])
def test_a_table_that_is_not_parted_by_commas_is_refused_for_that(mark: str, tmp_path: Path) -> None:
    """And not for the columns of the map, none of which it can hold."""
    (tmp_path / "log.csv").write_text("time,neck_deg\n0,1\n1,2\n".replace(",", mark))
    robot = make_robot(tmp_path / "robot", columns={"joint.<joint>.position": "<joint>_deg"})
    valid = "a first line of column names with commas between; decimal points"
    with pytest.raises(LogError, match=rf"has one column, 'time.neck_deg' \(valid: {valid}\)"):
        open_log(tmp_path / "log.csv", robot)


@pytest.mark.parametrize("source", ["q_<joint>", " q_<joint>"])
def test_blanks_beside_the_names_of_a_table_are_not_theirs(source: str, tmp_path: Path) -> None:
    """Loggers write a blank behind each comma; a map that says it too is as good."""
    (tmp_path / "log.csv").write_text("time, q_neck, t\n0, 3, 5\n1, 4, 6\n")
    columns = {"joint.<joint>.position": source, "time": source.replace("q_<joint>", "t")}
    log = open_log(tmp_path / "log.csv", make_robot(tmp_path / "robot", columns=columns))
    np.testing.assert_array_equal(log.columns["joint.neck.position"], [3, 4])
    np.testing.assert_array_equal(log.time, [5, 6])

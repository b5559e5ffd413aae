"""Files whole or not at all; messages of one line; conventions against SciPy's rotations."""

from __future__ import annotations

import hashlib
import os
import stat
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.conventions import rotation_from_quaternion, rotation_from_rpy, skew
from plantar.errors import MissingExtra, PlantarError, RobotError
from plantar.files import atomic_write, read_bounded, refuse_file, sha256, write_text
from plantar.notes import Note, unique


def test_a_file_appears_whole(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "er" / "result.json"
    with atomic_write(path) as handle:
        handle.write(b"half")
        assert not path.exists()
        handle.write(b" and half")
    assert path.read_bytes() == b"half and half"
    assert os.listdir(path.parent) == ["result.json"]


def test_an_error_leaves_the_old_content_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "result.json"
    write_text(path, "old")

    def fail_midway() -> None:
        with atomic_write(path) as handle:
            handle.write(b"new")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail_midway()
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["result.json"]


def test_files_have_the_usual_permissions(tmp_path: Path) -> None:
    ours, usual = tmp_path / "a", tmp_path / "b"
    write_text(ours, "x")
    usual.write_text("x")
    assert stat.S_IMODE(ours.stat().st_mode) == stat.S_IMODE(usual.stat().st_mode)


def test_what_cannot_be_written_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    with pytest.raises(PlantarError, match=r"result\.json: cannot be written: File exists$") as caught:
        write_text(tmp_path / "file" / "result.json", "x")
    assert "\n" not in str(caught.value)


def test_a_place_where_no_folder_can_be_is_refused_before_the_work(tmp_path: Path) -> None:
    """A file in its place or above it, and a folder of somebody else; nothing is made on the way."""
    (tmp_path / "file").write_text("x")
    for place in ("file", "file/out", "file/deep/out"):
        with pytest.raises(PlantarError, match=r"file: is a file \(valid: a folder for the results\)"):
            refuse_file(tmp_path / place)
    refuse_file(tmp_path / "new" / "out")
    assert not (tmp_path / "new").exists()
    with (
        mock.patch("os.access", return_value=False),
        pytest.raises(
            PlantarError,
            match=r"test_a_place_where_no_folder_c0: may not be written to \(valid: a folder of your own\)$",
        ),
    ):
        refuse_file(tmp_path / "new" / "out")


def test_hash_and_bounds(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"x" * 100)
    assert sha256(path) == hashlib.sha256(b"x" * 100).hexdigest()
    assert len(read_bounded(path, 100)) == 100
    with pytest.raises(RobotError, match=r"a: is larger than 99 bytes \(valid: a smaller file\)$"):
        read_bounded(path, 99, RobotError)
    with pytest.raises(RobotError, match=r"b: cannot be read: No such file or directory$"):
        read_bounded(tmp_path / "b", 99, RobotError)


def test_messages_have_a_fixed_order_and_one_line() -> None:
    error = PlantarError("is\nwrong", path="a.csv", column="time", time=1.25, value="x", valid="seconds")
    assert str(error) == "a.csv, column 'time', t = 1.25 s, value 'x': is wrong (valid: seconds)"
    assert str(PlantarError("is wrong")) == "is wrong"
    assert str(PlantarError("is wrong", value=np.float64(3.5))) == "value 3.5: is wrong"
    assert str(PlantarError("is wrong", time=-123456.75)) == "t = -123456.75 s: is wrong"
    assert str(PlantarError("is wrong", time=1_700_000_004.99)) == "t = 1700000004.99 s: is wrong"


def test_a_missing_extra_says_how_to_get_it() -> None:
    assert "pip install 'plantar[twin]'" in str(MissingExtra("mujoco", "twin", "the twin"))


def test_notes_once_each_in_order() -> None:
    one, two = Note("a", "info", "x"), Note("b", "warning", "y")
    assert unique([one, two, Note("a", "info", "x")]) == (one, two)
    assert one.to_dict() == {"code": "a", "severity": "info", "text": "x"}


def test_rotations_agree_with_scipys() -> None:
    random = np.random.default_rng(0)
    for rpy in random.uniform(-3, 3, size=(20, 3)):
        np.testing.assert_allclose(
            rotation_from_rpy(rpy), Rotation.from_euler("xyz", rpy).as_matrix(), atol=1e-12
        )
    quaternion = random.normal(size=(50, 4))
    expected = Rotation.from_quat(quaternion, scalar_first=True).as_matrix()
    np.testing.assert_allclose(rotation_from_quaternion(quaternion), expected, atol=1e-12)


def test_skew_is_the_cross_product() -> None:
    a, b = np.random.default_rng(1).normal(size=(2, 10, 3))
    np.testing.assert_allclose(np.einsum("nij,nj->ni", skew(a), b), np.cross(a, b), atol=1e-12)

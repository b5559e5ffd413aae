"""What a manifest may say, and the one line that tells what it may not."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import pytest

from plantar.errors import PlantarError
from plantar.fleet.manifest import Log, read_manifest, written

HEAD = "group,robot,log,role,time,unit\n"


def manifest(folder: Path, text: str) -> Path:
    path = folder / "fleet.csv"
    path.write_bytes(text.encode())
    return path


def test_rows_of_one_name_are_one_group_in_the_files_order(tmp_path: Path) -> None:
    rows = (
        "b,r.yaml,1.csv,,2026-05-04T09:30:00+02:00,7\na,/x/r.yaml,s3://bucket/2.csv,fit,,\n"
        "b,r.yaml,3.csv,validate,2026-05-03,7\n"
    )
    first, second = read_manifest(manifest(tmp_path, HEAD + rows))
    assert first.name == "b"
    assert first.robot == str(tmp_path / "r.yaml")
    assert first.logs == (Log(str(tmp_path / "1.csv"), "fit"), Log(str(tmp_path / "3.csv"), "validate"))
    assert (first.time, first.unit) == (datetime(2026, 5, 3, tzinfo=UTC), "7")
    assert (second.robot, second.logs) == ("/x/r.yaml", (Log("s3://bucket/2.csv", "fit"),))
    assert (second.time, second.unit) == (None, "r")


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    text = HEAD + 'one,/r.yaml,"/logs/a, b.csv",fit,2026-05-04T09:30:00Z,u 1\n'
    groups = read_manifest(manifest(tmp_path, text))
    assert written(groups) == text
    with_mark = read_manifest(manifest(tmp_path, "\ufeff" + text.replace("\n", "\r\n")))
    assert with_mark == groups


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "column 'group': is missing"),
        (HEAD, "holds no rows"),
        ("group,robot\na,b\n", "column 'log': is missing"),
        ("group,robot,log,rol\n", "column 'rol': is unknown"),
        ("group,robot,log,log\n", "column 'log': stands there twice"),
        (HEAD + "a,r.yaml,,,,\n", "column 'log': is empty in line 2"),
        (HEAD + "a,r.yaml,l.csv,test,,\n", "value 'test': is no role in line 2"),
        (HEAD + "a,r.yaml,l.csv,,yesterday,\n", "value 'yesterday': is no time in line 2"),
        (HEAD + "a,r.yaml,l.csv,validate,,\n", "group 'a' has no log to fit"),
        (HEAD + "a,r.yaml,l.csv,,,\na,q.yaml,k.csv,,,\n", "line 3 gives group 'a' another robot than line 2"),
        (
            HEAD + "a,r.yaml,l.csv,,,1\na,r.yaml,k.csv,,,2\n",
            "line 3 gives group 'a' another unit than line 2",
        ),
        (HEAD + "a,r.yaml,l.csv,,,\na,r.yaml,l.csv,,,\n", "line 3 names a log of group 'a' again"),
        (HEAD + "a,r.yaml,l.csv,,,,9\n", "line 2 has 1 cells more than the head"),
        (HEAD + 'a,r.yaml,"l.csv\n', "is not CSV"),
    ],
)
def test_a_wrong_manifest_is_one_line(text: str, said: str, tmp_path: Path) -> None:
    path = manifest(tmp_path, text)
    with pytest.raises(PlantarError) as told:
        read_manifest(path)
    assert said in str(told.value)
    assert str(path) in str(told.value)
    assert "\n" not in str(told.value)

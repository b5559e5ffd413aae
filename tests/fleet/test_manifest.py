"""What a manifest may say, and the one line that tells what it may not."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import pytest

from damaged import told
from kept_texts import assert_as_kept
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
    text += "two,/r.yaml,/c.csv,fit,,r\n"
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


def test_a_manifest_with_one_thing_wrong_is_as_it_is_kept(tmp_path: Path) -> None:
    """In its head or in one cell, or a row that is gone, twice or cut."""
    table = [
        HEAD.strip().split(","), ["a", "r.yaml", "1.csv", "fit", "2026-05-04T09:30:00Z", "u"],
        ["a", "r.yaml", "2.csv", "validate", "", "u"], ["b", "s.yaml", "s3://x/3.csv", "", "2026-05-03", ""],
    ]  # fmt: skip

    def read(rows: list[list[str]]) -> str:
        found = read_manifest(manifest(tmp_path, "\n".join(",".join(row) for row in rows) + "\n"))
        return "; ".join(f"{one.name} {one.robot} {one.time} {one.unit} {one.logs}" for one in found)

    cases = {"whole": table}
    for line, row in enumerate(table):
        beside = [table[:line], table[line + 1 :]]
        cases |= {
            f"{line} gone": [*beside[0], *beside[1]],
            f"{line} twice": [*beside[0], row, row, *beside[1]],
        }
        for place in range(len(row)):
            cases[f"{line} cut at {place}"] = [*beside[0], row[:place], *beside[1]]
            for other in ("", "x", "-1", '"', "2026-02-31"):
                changed = [*row[:place], other, *row[place + 1 :]]
                cases[f"{line} {place} {other!r}"] = [*beside[0], changed, *beside[1]]
    lines = [f"{where}: {told(read, rows)}\n" for where, rows in cases.items()]
    assert_as_kept(
        "".join(lines).replace(str(tmp_path), "FOLDER"), Path(__file__).parent / "kept" / "manifest.txt"
    )

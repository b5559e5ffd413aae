"""The documents: links lead somewhere, tables agree with the code, examples are valid."""

from __future__ import annotations

import re
from dataclasses import asdict
from itertools import pairwise
from pathlib import Path

import pytest
import yaml

from plantar.cli import COMMANDS
from plantar.logs.motion_log import COLUMN
from plantar.robot import schema
from plantar.robot.uncertainty import Uncertainty

ROOT = Path(__file__).resolve().parents[1]
DOCUMENTS = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").rglob("*.md")])


def anchors(text: str) -> set[str]:
    """The anchors of a document's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ +(.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_somewhere(document: Path) -> None:
    text = re.sub(r"```.*?```", "", document.read_text(), flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)\s]+)[^)]*\)|src=\"([^\"]+)\"", text):
        link = target[0] or target[1]
        if re.match(r"[a-z]+:", link):
            continue
        name, _, anchor = link.partition("#")
        path = document.parent / name if name else document
        assert path.exists(), link
        assert not anchor or path.suffix != ".md" or anchor in anchors(path.read_text()), link


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_commands_in_documents_exist(document: Path) -> None:
    verbs = {verb.split()[0] for verb in COMMANDS}
    for block in re.findall(r"```.*?```|`plantar [^`]*`", document.read_text(), re.DOTALL):
        for verb in re.findall(r"^[`$ ]*plantar ([a-z][a-z-]*)", block, re.MULTILINE):
            assert verb in verbs, verb


def test_every_documented_column_is_one() -> None:
    text = (ROOT / "docs" / "log_columns.md").read_text()
    columns = []
    for row in re.findall(r"^\| (`.+?) \|", text, re.MULTILINE):
        first, *others = re.findall(r"`([^`]+)`", row)
        columns += [first, *(first[: first.rindex(".")] + other for other in others)]
    assert columns[0] == "time"
    named = [re.sub(r"<\w+>", "any", column) for column in columns[1:]]
    assert len(named) == 4 + 4 + 6 + 6
    for column in named:
        assert COLUMN.fullmatch(column), column


def test_the_robot_files_example_is_valid() -> None:
    text = (ROOT / "docs" / "robot_file.md").read_text()
    example = re.findall(r"```yaml\n(.*?)```", text, re.DOTALL)[0]
    entry = schema.WHOLE_FILE.validate_python(yaml.safe_load(example))
    assert set(entry["feet"]) == {"left", "right"}


def test_every_key_of_the_robot_file_is_documented() -> None:
    text = (ROOT / "docs" / "robot_file.md").read_text()
    documented = {key for row in re.findall(r"^\| `([^`]+)`", text, re.MULTILINE) for key in row.split(".")}
    documented |= set(re.findall(r"`(\w+)`", text))
    parts = ("IMU", "FOOT", "FRAME", "WRENCH", "SOLE", "JOINT", "JOINT_NAMES", "UNCERTAINTY")
    for part in ("ROBOT", *parts):
        assert set(getattr(schema, part)) <= documented, part


def test_changes_are_listed_newest_first() -> None:
    versions = re.findall(
        r"^## \[(\d+)\.(\d+)\.(\d+)\] - (?:unreleased|\d{4}-\d\d-\d\d)$",
        (ROOT / "CHANGELOG.md").read_text(),
        re.MULTILINE,
    )
    assert versions
    kinds = re.findall(r"^### (.+)$", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert {*kinds} <= {"Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"}
    for newer, older in pairwise([tuple(map(int, version)) for version in versions]):
        assert newer > older


def test_the_defaults_of_uncertainty_are_documented() -> None:
    text = (ROOT / "docs" / "robot_file.md").read_text()
    for key, default in asdict(Uncertainty()).items():
        assert f"| `{key}` | {default} |" in text, key

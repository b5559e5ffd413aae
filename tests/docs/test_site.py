"""The site: it builds without a warning or a dead link, opens without a network, and leaves nothing public out."""

from __future__ import annotations

import inspect
import os
import re
import subprocess
import sys
import tomllib
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

import pytest
import yaml

import plantar
from check_site import faults
from command_reference import parameters, reference, section
from plantar.cli import COMMANDS
from plantar.results import feet
from plantar.results.dynamics import DynamicsResult
from plantar.results.feet import FeetResult
from raised_errors import line_for_each

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
API = (DOCS / "reference" / "api.md").read_text()
TOOLS = ("sphinx", "myst_nb", "furo")
missing = [tool for tool in TOOLS if find_spec(tool) is None]


@pytest.mark.skipif(bool(missing), reason=f"{missing} are not installed: `make docs` brings them")
def test_the_site_builds_without_a_warning_or_a_dead_link(tmp_path: Path) -> None:
    command = [
        sys.executable,
        "-m",
        "sphinx",
        "-E",
        "-W",
        "--keep-going",
        "-q",
        "-b",
        "html",
        *(
            "-D",
            "nb_execution_mode=off",
        ),  # `make docs` runs them, tests/docs/test_notebooks.py on small made logs
        str(DOCS),
        str(tmp_path),
    ]
    done = subprocess.run(
        command, capture_output=True, text=True, check=False, env={**os.environ, "NO_COLOR": "1"}
    )
    assert done.returncode == 0, done.stderr
    assert list(faults(tmp_path)) == []
    assert "stiffness" in (tmp_path / "searchindex.js").read_text()


def test_dead_links_and_what_is_loaded_from_elsewhere_are_found(tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text(
        '<a href="b.html#here">1</a><a href="b.html#gone">2</a><a href="c.html">3</a><a href="https://x.org">4</a>'
        '<script src="https://x.org/a.js"></script><img src="none.png"><link rel="stylesheet" href="//x.org/a.css">'
    )
    (tmp_path / "b.html").write_text('<p id="here"></p>')
    assert list(faults(tmp_path)) == [
        "a.html loads https://x.org/a.js",
        "a.html loads //x.org/a.css",
        "a.html: b.html#gone has no such place",
        "a.html: c.html leads nowhere",
        "a.html: none.png leads nowhere",
    ]


def test_every_page_is_in_the_contents() -> None:
    listed = {
        line
        for block in re.findall(r"```\{toctree\}\n(.*?)```", (DOCS / "index.md").read_text(), re.DOTALL)
        for line in re.findall(r"^[\w/]+$", block, re.MULTILINE)
    }
    files = [path for kind in ("*.md", "*.ipynb") for path in DOCS.rglob(kind)]
    pages = {str(path.relative_to(DOCS).with_suffix("")) for path in files} - {"index"}
    assert listed == pages


@pytest.mark.parametrize("verb", COMMANDS)
def test_the_reference_has_every_parameter_of_a_command(verb: str) -> None:
    run = import_module(f"plantar.cli.{COMMANDS[verb][0]}").run
    text = section(verb)
    assert len(parameters(verb)) == len(run.__annotations__) - 1  # all but what it returns
    for one in parameters(verb):
        assert one.help, f"plantar {verb} {one.names}"
        for name in one.names:
            assert f"`{name}`" in text
    assert f"plantar {verb}" in reference()


def test_the_reference_names_options_and_defaults_as_typer_does() -> None:
    known = {one.names: one for one in parameters("identify feet")}
    assert known["--offset",].choices == ("per-motion", "shared")
    assert known["--out",].needed
    assert known["--quiet", "-q"].default is False
    assert "Default: `per-motion`" in section("identify feet")


def test_the_reference_has_every_public_name() -> None:
    written = set(re.findall(r":: plantar\.(\w+)$", API, re.MULTILINE))
    assert set(plantar.__all__) - {"__version__"} <= written


@pytest.mark.parametrize("kind", [FeetResult, DynamicsResult])
def test_the_reference_has_the_rows_of_every_result(kind: type) -> None:
    """Each class of plantar that a field of a result holds has its module or itself in the page."""
    modules = set(re.findall(r"automodule:: ([\w.]+)$", API, re.MULTILINE))
    classes = set(re.findall(r"autoclass:: ([\w.]+)$", API, re.MULTILINE))
    for field in kind.__dataclass_fields__.values():
        for name in re.findall(r"\b[A-Z]\w+", str(field.type)):
            row = getattr(import_module(kind.__module__), name, None)
            if isinstance(row, type) and row.__module__.startswith("plantar."):
                assert row.__module__ in modules or f"{row.__module__}.{name}" in classes, name


def test_nothing_of_the_recipe_needs_the_network() -> None:
    recipe = (DOCS / "conf.py").read_text()
    assert "http" not in recipe
    assert "intersphinx" not in recipe


def test_every_key_of_a_result_is_documented() -> None:
    text = (DOCS / "reference" / "result_file.md").read_text()
    documented = set(re.findall(r"`(\w+)`", text))
    for kind in (FeetResult, DynamicsResult):
        for key in re.findall(r'"(\w+)":|content\["(\w+)"\]', inspect.getsource(kind.to_dict)):
            assert {*key} - {""} <= documented, key
    assert set(feet._IF_ANY) <= documented


def test_versions_agree() -> None:
    """One version, in the package; what else has to name it says the same."""
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert citation["version"] == plantar.__version__
    changes = (ROOT / "CHANGELOG.md").read_text()
    assert f"## [{plantar.__version__}] - " in changes
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["dynamic"] == ["version"]
    assert "version" not in project


def test_questions_lead_to_every_how_to_page() -> None:
    text = (DOCS / "how_to" / "questions.md").read_text()
    pages = {path.name for path in (DOCS / "how_to").glob("*.md")} - {"questions.md", "install.md"}
    assert pages == set(re.findall(r"\]\((\w+\.md)\)", text))


def test_every_picture_is_shown_and_made_by_a_script_that_stands_beside_it() -> None:
    scripts = "".join(path.read_text() for path in (DOCS / "images").glob("make_*.py"))
    pages = "".join(path.read_text() for path in [ROOT / "README.md", *DOCS.rglob("*.md")])
    for picture in (DOCS / "images").glob("*.png"):
        assert picture.name in pages, picture.name
        assert picture.name in scripts or f'"{picture.stem}"' in scripts, picture.name


def test_issue_forms_ask_for_the_bug_report() -> None:
    forms = [path.read_text() for path in (ROOT / ".github" / "ISSUE_TEMPLATE").glob("*.md")]
    assert len(forms) == 3
    assert sum("plantar bug-report" in form for form in forms) == 2


def test_each_error_has_a_line_of_its_own() -> None:
    text = """Read.

    Raises:
        RobotError: the file is wrong. LogError, DataError: a log
            cannot be used.
        Each is one line.

    Example:
        >>> 1
    """
    lines = line_for_each(inspect.cleandoc(text).splitlines())
    assert lines[2:6] == [
        "Raises:",
        "    RobotError: the file is wrong.",
        "    LogError, DataError: a log cannot be used. Each is one line.",
        "",
    ]
    assert line_for_each(["Nothing", "here."]) == ["Nothing", "here."]

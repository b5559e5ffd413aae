"""What a page tells its reader to type works, and what it shows is what comes out."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from example_folder import make_folder
from page_blocks import PRINTED, ROOT, RUN, blocks, shown
from page_folders import STAND_INS, force_cells, many_formats, nothing, other_names, own_logs, with_robot_file
from page_runner import Reader, same

DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]
# Kinds of blocks that are shown and not typed. YAML and JSON have tests of their own.
SHOWN = (
    PRINTED,
    "text",
    "yaml",
    "json",
    "{toctree}",
    "{eval-rst}",
    "{commands}",
    "{cpp-reference}",
    "{include}",
    "{literalinclude}",
)

# Pages that start from files of the reader: what they find in their folder.
OWN: dict[str, Callable[[Path], object]] = {
    "README.md": own_logs,
    "docs/formats.md": many_formats,
    "docs/log_columns.md": with_robot_file,
    "docs/robot_file.md": own_logs,
    "docs/walking.md": with_robot_file,
    "docs/walks.md": with_robot_file,
    "docs/how_to/install.md": nothing,
    "docs/how_to/fleet.md": with_robot_file,
    "docs/how_to/other_names.md": other_names,
    "docs/how_to/force_cells.md": force_cells,
    "docs/how_to/try_on_twin.md": own_logs,
    "docs/how_to/solref.md": nothing,
    "docs/how_to/regressors.md": nothing,
}
# Pages that go on from a robot, logs and results: those of the examples in docstrings.
RESULTS = (
    "docs/how_to/contact_elsewhere.md",
    "docs/how_to/cores.md",
    "docs/how_to/mujoco_contact.md",
    "docs/how_to/randomisation.md",
    "docs/how_to/stabiliser.md",
    "docs/how_to/observer.md",
    "docs/how_to/online.md",
    "docs/how_to/openhrp.md",
    "docs/how_to/excitation.md",
    "docs/how_to/identifiability.md",
    "docs/how_to/joint_friction.md",
)
# Pages that make their logs by `plantar simulate`: here on small made logs, by `make docs-test` on the twin.
TWIN = (
    "docs/start.md",
    "docs/tutorials/own_robot.md",
    "docs/tutorials/walking.md",
    "docs/tutorials/mujoco.md",
    "docs/tutorials/choose_motions.md",
    "docs/tutorials/design.md",
    "docs/tutorials/fleet.md",
    "docs/tutorials/controller.md",
)
# Pages that play their logs in a simulator again, which small made logs are not made for.
PLAYED = ("docs/how_to/compare_in_simulator.md",)
# Whose snippets another test runs, or why they do not run.
ELSEWHERE = {
    "docs/python.md": "tests/test_front_door.py",
    "docs/report.md": "tests/test_front_door.py",
    "docs/how_to/design.md": "tests/design/test_story.py",
    "docs/campaign.md": "the whole campaign takes minutes of the twin",
}


def assert_shown(reader: Reader) -> None:
    for block, outputs in reader.outputs.items():
        for one, output in zip(shown(block), outputs, strict=True):
            assert same(one.output, output), f"{block.where}: {one.command}\n{output}"


def typed(page: Path) -> bool:
    return any(block.kind in RUN for block in blocks(page))


def test_every_page_with_something_to_type_is_run() -> None:
    pages = {str(page.relative_to(ROOT)) for page in PAGES if typed(page)}
    assert pages == {*OWN, *RESULTS, *TWIN, *PLAYED, *ELSEWHERE}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_block_says_what_it_is(page: Path) -> None:
    """So that no command stands in a block that nobody runs."""
    for block in blocks(page):
        kind = block.kind.split()[0] if block.kind else ""
        assert kind in (*RUN, *SHOWN), f"{block.where}: a block of kind '{kind}'"
        if kind == "text":
            assert not re.search(r"^\$? ?plantar [a-z]", block.text, re.MULTILINE), (
                f"{block.where}: nobody runs this"
            )


@pytest.mark.parametrize("page", OWN)
def test_a_page_works_on_the_readers_own_files(page: str, tmp_path: Path) -> None:
    OWN[page](tmp_path)
    reader = Reader(tmp_path, STAND_INS)
    reader.read(ROOT / page)
    assert_shown(reader)


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_folder(tmp_path_factory.mktemp("results"))


@pytest.mark.usefixtures("contact_at_one_step")
@pytest.mark.parametrize("page", RESULTS)
def test_a_page_works_on_a_readers_results(page: str, results: Path, tmp_path: Path) -> None:
    shutil.copytree(results, tmp_path, dirs_exist_ok=True)
    Reader(tmp_path, STAND_INS).read(ROOT / page)


@pytest.mark.parametrize("page", TWIN)
def test_a_page_works_on_small_made_logs(page: str, tmp_path: Path) -> None:
    Reader(tmp_path, STAND_INS).read(ROOT / page)


@pytest.mark.twin_pages
@pytest.mark.parametrize("page", [*TWIN, *PLAYED])
def test_a_page_shows_what_the_twin_gives(page: str, tmp_path: Path) -> None:
    reader = Reader(tmp_path)
    reader.read(ROOT / page)
    assert_shown(reader)


def test_a_command_that_fails_is_told(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("```sh\nplantar inspect none.yaml none.csv\n```\n")
    with pytest.raises(
        AssertionError, match=r"page\.md:1: plantar inspect none\.yaml none\.csv\nplantar: none\.yaml"
    ):
        Reader(tmp_path).read(page)


@pytest.mark.parametrize(
    ("expected", "printed", "equal"),
    [("a  1\n", "a 1  \n", True), ("a ...\nc\n", "a b\nc\n", True), ("a 1\n", "a 2\n", False)],
)
def test_an_output_that_differs_is_told(expected: str, printed: str, equal: bool) -> None:
    assert same(expected, printed) == equal

"""Notebooks: stored without outputs, and their cells run as they are, here on small made logs."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from page_blocks import ROOT
from page_folders import STAND_INS
from page_runner import Reader
from plantar.results.feet import FeetResult

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
named = pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)


@named
def test_nothing_that_was_run_is_stored(notebook: Path) -> None:
    """Outputs come from the build of the site, so none is older than the code."""
    content = json.loads(notebook.read_text())
    assert content["metadata"]["kernelspec"]["name"] == "python3"
    for cell in content["cells"]:
        if cell["cell_type"] == "code":
            assert (cell["outputs"], cell["execution_count"]) == ([], None)


@named
def test_a_notebook_runs(notebook: Path, tmp_path: Path) -> None:
    reader = Reader(tmp_path, STAND_INS)
    reader.run_notebook(notebook)
    assert any(isinstance(value, FeetResult) for value in reader.names.values())


def test_there_are_some() -> None:
    assert len(NOTEBOOKS) == 3

"""The front door in Python: what `dir` and `help` show, examples that run, input of any kind, one-line errors."""

from __future__ import annotations

import doctest
import inspect
import math
import os
import pydoc
import re
import subprocess
import sys
from collections.abc import Callable
from operator import attrgetter
from pathlib import Path
from typing import Any

import pytest

import plantar
from example_folder import make_folder
from kept_texts import assert_as_kept
from plantar.design.story import DesignSettings
from plantar.errors import SettingsError
from plantar.feet.settings import FeetSettings

ROOT = Path(__file__).resolve().parents[1]
PROMISED = {
    "load_robot", "open_log", "identify_feet", "identify_inertia", "identify_joints", "validate_feet", "export",
    "select_motions", "read_residuals", "plot_torque", "FeetSettings", "DynamicsSettings", "FootEstimator",
    "FeetResult", "DynamicsResult", "RobotModel", "MotionLog", "PlantarError", "RobotError", "LogError", "DataError",
    "SettingsError", "MotionError", "ExportError", "MissingExtra", "FootHysteresis", "dynamics",
}  # fmt: skip
KNOWN = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_folder(tmp_path_factory.mktemp("examples"))


@pytest.fixture
def inside(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The examples' folder as the working directory, and pictures that need no screen."""
    monkeypatch.chdir(folder)
    monkeypatch.setenv("MPLBACKEND", "agg")
    return folder


def functions() -> list[str]:
    """Public functions, and those of `plantar.dynamics` for arrays."""
    names = [name for name in sorted(PROMISED) if inspect.isfunction(getattr(plantar, name))]
    arrays = [
        name for name in plantar.dynamics.__all__ if inspect.isfunction(getattr(plantar.dynamics, name))
    ]
    return [*names, *(f"dynamics.{name}" for name in arrays)]


def public(name: str) -> Any:
    return attrgetter(name)(plantar)


def classes() -> list[str]:
    return [name for name in sorted(PROMISED) if inspect.isclass(getattr(plantar, name))]


def documented() -> list[tuple[str, Any]]:
    """Every public function and class, and the methods of results that have an example."""
    found = [(name, public(name)) for name in (*functions(), *classes())]
    for name in ("FeetResult", "DynamicsResult"):
        kind = getattr(plantar, name)
        found += [(f"{name}.{method}", getattr(kind, method)) for method in ("load", "to_table")]
    return [(name, thing) for name, thing in found if ">>>" in (thing.__doc__ or "")]


def test_dir_shows_the_api_and_nothing_else() -> None:
    assert {name for name in dir(plantar) if not name.startswith("__")} == PROMISED
    assert set(plantar.__all__) == PROMISED | {"__version__"}


def test_what_the_api_takes_and_holds_is_as_it_is_kept() -> None:
    """Every public name with its arguments, in their order and with their defaults."""
    lines = []
    for name in (*functions(), *classes()):
        thing = public(name)
        lines.append(f"{name}{inspect.signature(thing)}")
        own = vars(thing).items() if inspect.isclass(thing) else ()
        lines += [
            f"  {part}{inspect.signature(getattr(thing, part))}" if callable(getattr(thing, part)) else f"  {part}"
            for part, _ in sorted(own) if not part.startswith("_")
        ]  # fmt: skip
    text = re.sub(r" at 0x\w+", "", "\n".join(lines)) + "\n"
    assert_as_kept(text, Path(__file__).parent / "kept" / "api.txt")


@pytest.mark.parametrize(
    "kind", [FeetSettings, plantar.DynamicsSettings, DesignSettings], ids=lambda one: one.__name__
)
def test_settings_of_which_one_is_out_of_place_are_as_they_are_kept(kind: Any) -> None:
    """Whether it is taken, or the line that says what would be."""
    lines = []
    for name in inspect.signature(kind).parameters:
        for value in (None, "x", True, math.nan, math.inf, -1e9, -1.0, -0.05, 0.0, 1e-3, 0.1, 3.2, 25.0, 1e9):
            try:
                found = repr(getattr(kind(**{name: value}), name))
            except SettingsError as error:
                found = f"refused: {error}"
            lines.append(f"{name} {value!r}: {found}")
    assert_as_kept("\n".join(lines) + "\n", Path(__file__).parent / "kept" / f"{kind.__name__}.txt")


def test_help_shows_every_function_and_class() -> None:
    page = pydoc.render_doc(plantar, renderer=pydoc.plaintext)
    for name in (name for name in functions() if "." not in name):
        assert re.search(rf"^    {name}\(", page, re.MULTILINE), name
    for name in classes():
        assert re.search(rf"class {name}\(", page), name


def test_export_is_the_function_whatever_was_imported_before() -> None:
    code = "import plantar.exporters.urdf.tree, plantar; print(plantar.export.__name__, callable(plantar.export))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["export", "True"]


@pytest.mark.parametrize("name", functions())
def test_every_function_says_what_goes_in_and_out(name: str) -> None:
    function = public(name)
    text = inspect.getdoc(function) or ""
    for part in ("Args:", "Returns:", "Raises:", "Example:"):
        assert re.search(rf"^{part}$", text, re.MULTILINE), f"{name}: {part}"
    arguments = re.search(r"^Args:\n(.*?)^Returns:", text, re.MULTILINE | re.DOTALL)
    assert arguments is not None
    listed = re.findall(r"^    (\w+):", arguments[1], re.MULTILINE)
    assert listed == list(inspect.signature(function).parameters), name


@pytest.mark.parametrize("name", [name for name in classes() if not name.endswith(("Error", "Extra"))])
def test_every_class_names_each_of_its_fields(name: str) -> None:
    kind = getattr(plantar, name)
    text = inspect.getdoc(kind) or ""
    assert "Example:" in text
    for field in getattr(kind, "__dataclass_fields__", inspect.signature(kind).parameters):
        assert re.search(rf"\b{field}\b", text), f"{name}.{field}"


@pytest.mark.parametrize(("name", "thing"), documented(), ids=[name for name, _ in documented()])
def test_examples_of_docstrings_run(
    name: str, thing: Any, inside: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In an empty namespace: an example imports what it needs."""
    monkeypatch.setattr("plantar.exporters.contact.fit.STEPS", (0.001,))  # a third of the time
    examples = doctest.DocTestParser().get_doctest(inspect.getdoc(thing) or "", {}, name, None, 0)
    told: list[str] = []
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS)
    runner.run(examples, out=told.append)
    assert runner.failures == 0, "".join(told)
    assert runner.tries > 0


def test_the_packages_own_example_runs(inside: Path) -> None:
    block = re.search(r"^    import plantar\n.*?\n(?=\n\S)", plantar.__doc__ or "", re.MULTILINE | re.DOTALL)
    assert block is not None
    exec(compile(inspect.cleandoc(block[0]), "help(plantar)", "exec"), {})
    assert (inside / "robot_on_bushes.xml").is_file()


def test_the_notebook_runs(folder: Path, tmp_path: Path) -> None:
    for name in ("robot.yaml", "biped.urdf", "sway_1.csv", "squat.csv"):
        (tmp_path / name).write_bytes((folder / name).read_bytes())
    (tmp_path / "squat.csv").rename(tmp_path / "z_squat.csv")
    command = [sys.executable, str(ROOT / "examples" / "notebook_like.py"), str(tmp_path)]
    environment = {**os.environ, "MPLBACKEND": "agg", "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    assert done.returncode == 0, done.stderr
    assert "left   pitch  stiffness" in done.stdout
    assert {"pitch.png", "feet", "robot_on_bushes.xml"} <= {path.name for path in tmp_path.iterdir()}


def test_the_document_runs_and_names_every_residual_column(inside: Path) -> None:
    text = (ROOT / "docs" / "python.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    names: dict[str, Any] = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)
    rows = re.findall(r"^\| (`.+?) \|", text.split("## The residuals")[1], re.MULTILINE)
    columns = [column for row in rows for column in re.findall(r"`([^`]+)`", row)]
    assert sorted(columns) == sorted(names["result"].residuals.column_names)


def test_the_snippets_of_the_report_run(inside: Path) -> None:
    names: dict[str, Any] = {}
    for block in re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "report.md").read_text(), re.DOTALL):
        exec(compile(block, "docs/report.md", "exec"), names)
    assert (inside / "out" / "inertia" / "report.html").is_file()
    assert names["pictures"]


def test_paths_and_objects_give_the_same(inside: Path) -> None:
    robot = plantar.load_robot("robot.yaml")
    by_object = plantar.identify_feet(robot, [plantar.open_log("sway_1.csv", robot)], settings=KNOWN)
    by_path = plantar.identify_feet("robot.yaml", Path("sway_1.csv"), settings=KNOWN)
    assert by_path.parameters == by_object.parameters
    assert by_path.inputs == by_object.inputs
    scores = [
        plantar.validate_feet(source, robot, "squat.csv") for source in (by_path, by_path.save("out/path"))
    ]
    assert scores[0] == scores[1]


@pytest.mark.parametrize(
    ("call", "kind", "expected"),
    [
        (lambda: plantar.identify_feet({}, []), plantar.RobotError, "a RobotModel or the path of a robot file"),
        (lambda: plantar.identify_feet("robot.yaml", 3), plantar.LogError, "a MotionLog, the path of a log"),
        (lambda: plantar.identify_feet("robot.yaml", [None]), plantar.LogError, "a MotionLog, the path of a log"),
        (lambda: plantar.identify_feet("robot.yaml", "none.csv"), plantar.LogError, "none.csv: does not exist"),
        (lambda: plantar.identify_feet("robot.yaml", []), plantar.DataError, "at least one"),
        (lambda: plantar.identify_joints("arm.yaml", "arm.csv", inertia="x"), plantar.SettingsError, "together"),
        (lambda: plantar.validate_feet("arm.yaml", "robot.yaml", "squat.csv"), plantar.PlantarError, "arm.yaml"),
        (lambda: plantar.validate_feet("out/inertia", "robot.yaml", "squat.csv"), plantar.PlantarError, "feet/1"),
        (lambda: plantar.export("out/feet", "lego", "x"), plantar.ExportError, "mjcf"),
        (lambda: plantar.export(7, "mjcf", "x"), plantar.ExportError, "a FeetResult"),
        (lambda: plantar.identify_feet("robot.yaml", "sway_1.csv", settings={}), plantar.SettingsError,
         "value 'dict': settings are not settings (valid: plantar.FeetSettings(...))"),
        (lambda: plantar.identify_inertia("robot.yaml", "sway_1.csv", settings=KNOWN), plantar.SettingsError,
         "plantar.DynamicsSettings(...)"),
        (lambda: plantar.open_log("sway_1.csv", "none.yaml"), plantar.RobotError, "none.yaml: cannot be read"),
        (lambda: plantar.export("out/feet", "yaml", "out"), plantar.PlantarError, "it is a folder"),
        (lambda: plantar.FeetResult.load("out/feet").parameter("left", "pich", "stiffness"), KeyError,
         "no parameter left pich stiffness (valid: "),
        (lambda: plantar.read_residuals("out"), plantar.PlantarError, "residuals.parquet"),
    ],
)  # fmt: skip
def test_wrong_input_is_one_line(
    call: Callable[[], object], kind: type[Exception], expected: str, inside: Path
) -> None:
    with pytest.raises(kind, match=re.escape(expected)) as caught:
        call()
    assert "\n" not in str(caught.value)


def test_an_unknown_name_is_no_attribute() -> None:
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = plantar.nonsense

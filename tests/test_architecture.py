"""The shape of the package: which room may import which, who prints, who draws, how long a file is."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "src" / "plantar"
FILES = sorted(SOURCE.rglob("*.py"))

# A room imports only from rooms that stand before it.
ROOMS = (
    "conventions", "errors", "choices", "notes", "pages", "files", "handed_back", "cores",
    "robot", "logs", "signals", "contact", "faults",
    "dynamics", "models", "estimation", "model_selection",
    "results", "sensors", "feet", "whole_body",
    "online",
    "motions", "twin", "design",
    "inspection", "exporters", "robot_guess", "fleet", "report", "campaign", "comparison", "cli",
)  # fmt: skip
# So does a folder or a file inside `feet`: from those before it.
FEET = (
    "settings", "recording", "coherent_band", "regression", "place", "fit", "interval_width", "exclusion", "assess",
    "internal_error", "prepare_log", "first_look", "prepare",
    "foot_fit", "foot_assessment", "put_right", "shared_hysteresis", "assumptions",
    "result", "identify", "validate",
)  # fmt: skip
# Two identifications that know nothing of one another: what both need stands in an earlier room.
APART = ("feet", "whole_body")
LARGEST_ROOM = 0.15  # of all lines
FULLEST_FOLDER = 16  # Python files

# Rooms that decide numbers: each of their modules is imported by a test of its own room.
TESTED = (
    "signals", "contact", "faults", "estimation", "model_selection", "sensors", "feet", "whole_body", "results",
    "online", "fleet",
)  # fmt: skip
# The one place that catches what nobody thought of: an axis is given up, the result says so.
CATCHES_ALL = "src/plantar/feet/internal_error.py"
ENTRANCES = ("__init__", "__main__")  # they name what others hold
LONGEST = 350  # lines

# Who may import what is heavy, optional or has effects.
KEEPERS = {
    "plantar._core": {"contact", "dynamics", "estimation", "logs", "models", "online", "signals", "twin"},
    "mujoco": {"twin", "exporters"},
    "pink": {"motions", "twin"},
    "qpsolvers": {"motions", "twin"},
    "clarabel": {"dynamics", "estimation"},
    "rosbags": {"logs"},
    "msgpack": {"logs"},
    "h5py": {"logs"},
    "matplotlib": {"report"},
    "viser": {"report"},
    "jinja2": {"report"},
    "dask": {"fleet"},
    "distributed": {"fleet"},
    "fsspec": {"fleet"},
    "typer": {"cli"},
    "rich": {"cli"},
    "pickle": {"handed_back"},  # between a process and its own copy, never from a file
    "socket": set(),
    "urllib": set(),
    "requests": set(),
    "subprocess": set(),
}


def room(path: Path) -> str:
    return path.relative_to(SOURCE).parts[0].removesuffix(".py")


@cache
def nodes(path: Path) -> tuple[Any, ...]:
    """Everything that a file says."""
    return tuple(ast.walk(ast.parse(path.read_text())))


@cache
def imports(path: Path) -> tuple[tuple[str, int], ...]:
    """Dotted names that a file imports, wherever in it, with their lines; of plantar's own, the files' modules."""
    found = []
    for node in nodes(path):
        if isinstance(node, ast.Import):
            found += [(alias.name, node.lineno) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}:{node.lineno}: relative import"
            module = node.module or ""
            inner = [f"{module}.{alias.name}" for alias in node.names]
            found += [
                (name if module == "plantar" or name in MODULES else module, node.lineno) for name in inner
            ]
    return tuple(found)


def module_of(path: Path) -> str:
    """The dotted name of a file of the package; a folder's `__init__` has the folder's."""
    parts = path.relative_to(SOURCE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_of(path): path for path in FILES}


def where(path: Path, line: int) -> str:
    return f"{path.relative_to(ROOT)}:{line}"


def out_of_order(order: Sequence[str], above: str) -> list[str]:
    """Imports below the package `above` of what stands behind the importer in `order`."""
    wrong, depth = [], len(above.split("."))
    for module, path in MODULES.items():
        if not module.startswith(f"{above}.") or (place := module.split(".")[depth]) in ENTRANCES:
            continue
        before = {*order[: order.index(place) + 1], "_core", "__version__"}
        wrong += [
            f"{where(path, line)} imports {name}"
            for name, line in imports(path)
            if name.startswith(f"{above}.") and name.split(".")[depth] not in before
        ]
    return wrong


def inside(folder: Path) -> set[str]:
    """What stands in a folder of the package: its files and folders, without what names others."""
    names = {path.name for path in folder.iterdir() if path.is_dir() and any(path.rglob("*.py"))}
    return names | {path.stem for path in folder.glob("*.py")} - set(ENTRANCES)


def test_every_room_has_its_place_and_every_place_its_room() -> None:
    assert inside(SOURCE) == set(ROOMS)
    assert inside(SOURCE / "feet") == set(FEET)


def test_imports_point_one_way() -> None:
    assert out_of_order(ROOMS, "plantar") == []
    assert out_of_order(FEET, "plantar.feet") == []


def test_the_two_identifications_stand_apart() -> None:
    wrong = [
        f"{where(path, line)} imports {name}"
        for path in FILES
        for name, line in imports(path)
        if room(path) in APART
        and name.split(".")[:1] == ["plantar"]
        and name.split(".")[1] in {*APART} - {room(path)}
    ]
    assert wrong == []


def test_no_file_imports_itself_by_a_detour() -> None:
    """Imports inside functions and for types count too. The package's own entrance names what others hold."""
    left = {
        module: {name for name, _ in imports(path) if name in MODULES} - {module, "plantar"}
        for module, path in MODULES.items()
        if module != "plantar"
    }
    while free := {module for module, needed in left.items() if not needed & left.keys()}:
        left = {module: needed for module, needed in left.items() if module not in free}
    assert sorted(left) == [], "files in a circle, or behind one"


def test_no_room_takes_too_large_a_part_and_no_folder_is_too_full() -> None:
    lines: Counter[str] = Counter()
    for path in FILES:
        lines[room(path)] += len(path.read_text().splitlines())
    limit = LARGEST_ROOM * lines.total()
    assert {name: count for name, count in lines.items() if count > limit} == {}
    files = Counter(str(path.parent.relative_to(SOURCE)) for path in FILES)
    assert {folder: count for folder, count in files.items() if count > FULLEST_FOLDER} == {}


def test_every_module_that_decides_numbers_has_a_test_in_its_room() -> None:
    untested = set()
    for name in TESTED:
        tests = (ROOT / "tests" / name).rglob("test_*.py")
        imported = {found for path in tests for found, _ in imports(path)}
        own = {module for module in MODULES if module.startswith(f"plantar.{name}.")}
        packages = {module for module in own if MODULES[module].name == "__init__.py"}
        untested |= {module.removeprefix("plantar.") for module in own - packages - imported}
    assert untested == set()


def test_heavy_parts_have_their_keepers() -> None:
    wrong = []
    for path in FILES:
        for name, line in imports(path):
            part = next((part for part in KEEPERS if name == part or name.startswith(part + ".")), None)
            if part is not None and room(path) not in KEEPERS[part]:
                wrong.append(f"{where(path, line)} imports {part}")
    assert wrong == []


def test_only_the_command_line_prints_or_exits() -> None:
    forbidden = {"print", "input", "exit", "quit", "sys.exit", "os._exit", "eval", "exec"}
    ends_its_copies = {("cores", "os._exit")}
    wrong = []
    for path in FILES:
        for node in nodes(path):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in forbidden and room(path) != "cli":
                if (room(path), ast.unparse(node.func)) in ends_its_copies:
                    continue
                wrong.append(f"{where(path, node.lineno)} calls {ast.unparse(node.func)}")
    assert wrong == []


def test_files_are_short_say_what_they_are_and_are_well_named() -> None:
    wrong = []
    for path in FILES:
        text = path.read_text()
        if len(text.splitlines()) > LONGEST:
            wrong.append(f"{path.relative_to(ROOT)} has more than {LONGEST} lines")
        if re.search(r"util|helper|common|misc", path.stem):
            wrong.append(f"{path.relative_to(ROOT)}: a name that says nothing")
        if text.strip() and not ast.get_docstring(nodes(path)[0]):
            wrong.append(f"{path.relative_to(ROOT)} has no docstring")
    assert wrong == []


def test_errors_are_caught_by_name() -> None:
    """A bare or general `except` hides what nobody thought of, unless it raises again."""
    wrong = []
    assert (ROOT / CATCHES_ALL).is_file()
    for path in set(FILES) - {ROOT / CATCHES_ALL}:
        for node in nodes(path):
            if isinstance(node, ast.ExceptHandler):
                kind = ast.unparse(node.type) if node.type else "everything"
                raises = any(isinstance(inner, ast.Raise) for inner in ast.walk(node))
                if kind in ("everything", "Exception", "BaseException") and not raises:
                    wrong.append(f"{where(path, node.lineno)} catches {kind}")
    assert wrong == []


def test_the_kernel_knows_no_python_outside_its_bindings() -> None:
    sources = [path for path in (ROOT / "cpp").rglob("*") if path.suffix in (".hpp", ".cpp")]
    assert sources
    for path in sources:
        text = path.read_text()
        assert len(text.splitlines()) <= LONGEST, path.name
        if path.parent.name != "python":
            assert "nanobind" not in text, path.name
            assert "Python.h" not in text, path.name

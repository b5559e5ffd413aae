"""The shape of the package: which room may import which, who prints, who draws, how long a file is."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "src" / "plantar"
FILES = sorted(SOURCE.rglob("*.py"))

# A room imports only from rooms that stand before it.
ROOMS = (
    "conventions", "errors", "notes", "files",
    "joint_names", "robot_guesses", "robot_uncertainty", "robot_file", "robot", "log", "readers",
    "signals", "spikes", "kinematics", "attitude", "polygon", "contact", "slip", "deflection",
    "sanity_channels", "sanity_feet", "sanity_imu", "sanity_joints", "sanity",
    "dynamics", "models", "estimation",
    "result", "validation", "identify",
    "balance", "motions", "twin",
    "inspection", "export", "robot_guess", "report", "campaign", "cli",
)  # fmt: skip
ENTRANCES = ("__init__", "__main__")  # they name what others hold
LONGEST = 350  # lines

# Who may import what is heavy, optional or has effects.
KEEPERS = {
    "plantar._core": {"dynamics", "deflection", "twin"},
    "mujoco": {"twin", "export"},
    "pink": {"motions", "twin"},
    "qpsolvers": {"motions", "twin"},
    "clarabel": {"dynamics", "estimation"},
    "rosbags": {"readers"},
    "msgpack": {"readers"},
    "h5py": {"readers"},
    "matplotlib": {"report"},
    "viser": {"report"},
    "jinja2": {"report"},
    "typer": {"cli"},
    "rich": {"cli"},
    "pickle": set(),
    "socket": set(),
    "urllib": set(),
    "requests": set(),
    "subprocess": set(),
}


def room(path: Path) -> str:
    return path.relative_to(SOURCE).parts[0].removesuffix(".py")


def imports(path: Path) -> Iterator[tuple[str, int]]:
    """Dotted names that a file imports, wherever in it, with their lines."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from ((alias.name, node.lineno) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}:{node.lineno}: relative import"
            module = node.module or ""
            whole = [f"plantar.{alias.name}" for alias in node.names] if module == "plantar" else [module]
            yield from ((name, node.lineno) for name in whole)


def where(path: Path, line: int) -> str:
    return f"{path.relative_to(ROOT)}:{line}"


def test_every_room_has_its_place() -> None:
    found = {room(path) for path in FILES} - set(ENTRANCES)
    assert found <= set(ROOMS), f"rooms without a place in the order: {sorted(found - set(ROOMS))}"


def test_imports_point_one_way() -> None:
    wrong = []
    for path in FILES:
        if room(path) not in ENTRANCES:
            before = {*ROOMS[: ROOMS.index(room(path)) + 1], "_core", "__version__"}
            own = [(name, line) for name, line in imports(path) if name.startswith("plantar.")]
            wrong += [
                f"{where(path, line)} imports {name}"
                for name, line in own
                if name.split(".")[1] not in before
            ]
    assert wrong == []


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
    wrong = []
    for path in FILES:
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in forbidden and room(path) != "cli":
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
        if text.strip() and not ast.get_docstring(ast.parse(text)):
            wrong.append(f"{path.relative_to(ROOT)} has no docstring")
    assert wrong == []


def test_errors_are_caught_by_name() -> None:
    """A bare or general `except` hides what nobody thought of, unless it raises again."""
    wrong = []
    for path in FILES:
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ExceptHandler):
                kind = ast.unparse(node.type) if node.type else "everything"
                raises = any(isinstance(inner, ast.Raise) for inner in ast.walk(node))
                if kind in ("everything", "Exception", "BaseException") and not raises:
                    wrong.append(f"{where(path, node.lineno)} catches {kind}")
    assert wrong == []


def test_the_kernel_knows_no_python_outside_its_bindings() -> None:
    for path in sorted((ROOT / "cpp").iterdir()):
        if path.suffix in (".hpp", ".cpp"):
            text = path.read_text()
            assert len(text.splitlines()) <= LONGEST, path.name
            if not path.name.startswith("bindings"):
                assert "nanobind" not in text, path.name
                assert "Python.h" not in text, path.name

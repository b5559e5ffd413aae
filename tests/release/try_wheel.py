"""A release as its users get it: sdist and wheel built, the wheel tried in a fresh environment without a compiler.

python tests/release/try_wheel.py [FOLDER]        # sdist and wheel go to FOLDER, dist where left out

It needs the network for what plantar needs. `make wheel` runs it.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LARGEST = 5e6  # bytes
# Rooms with and without the native part, the command line, and exports loaded in their simulators.
TESTS = (
    "models",
    "estimation",
    "dynamics",
    "exporters",
    "feet/test_identify.py",
    "cli/test_start.py",
    "cli/test_bug_report.py",
)


def python_in(folder: Path) -> Path:
    """A fresh environment."""
    venv.create(folder, with_pip=True)
    return folder / "bin" / "python"


def run(*command: object, where: Path, environment: dict[str, str] | None = None) -> None:
    words = [str(word) for word in command]
    print("$", " ".join(words), flush=True)
    subprocess.run(words, cwd=where, env=environment, check=True)


def built(out: Path, work: Path) -> Path:
    """The wheel, made from the sdist, beside it in `out`."""
    python = python_in(work / "build")
    run(python, "-m", "pip", "install", "--quiet", "build", where=work)
    run(python, "-m", "build", "--outdir", out, ROOT, where=work)
    return max(out.glob("plantar-*.whl"), key=lambda wheel: wheel.stat().st_mtime)


def without_compiler(environment: Path) -> dict[str, str]:
    """Variables under which no compiler and no build tool can be found."""
    kept = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith(("CC", "CXX", "CMAKE", "PYTHON"))
    }
    return {**kept, "PATH": str(environment / "bin"), "CC": "/nonexistent", "CXX": "/nonexistent"}


def tried(wheel: Path, work: Path) -> None:
    """Install the wheel in a fresh environment and use it, far from the sources."""
    python = python_in(work / "fresh")
    bare = without_compiler(work / "fresh")
    bare |= {"PLANTAR_CACHE": str(work / "cache"), "OPENBLAS_NUM_THREADS": "1"}
    only = ("--only-binary", ":all:")
    run(python, "-m", "pip", "install", "--quiet", *only, f"{wheel}[all,test]", where=work, environment=bare)
    plantar = work / "fresh" / "bin" / "plantar"
    run(plantar, "--help", where=work, environment=bare)
    run(
        plantar,
        "simulate",
        "Squat",
        "--preset",
        "sensors",
        "--out",
        "logs",
        "--quiet",
        where=work,
        environment=bare,
    )
    run(plantar, "identify", "feet", "logs/robot.yaml", "logs/Squat.parquet", "--out", "out", "--quiet",
        where=work, environment=bare)  # fmt: skip
    shutil.copytree(ROOT / "tests", work / "sources" / "tests")
    shutil.copy(ROOT / "pyproject.toml", work / "sources")
    for folder in ("benchmarks", "docs"):
        shutil.copytree(ROOT / folder, work / "sources" / folder)
    run(
        python, "-m", "pytest", *(f"tests/{name}" for name in TESTS), where=work / "sources", environment=bare
    )


def main() -> None:
    out = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "dist").resolve()
    with tempfile.TemporaryDirectory() as folder:
        wheel = built(out, Path(folder))
        size = wheel.stat().st_size
        print(f"{wheel.name}: {size / 1e6:.2f} MB")
        if size > LARGEST:
            sys.exit(f"the wheel is larger than {LARGEST / 1e6:g} MB")
        tried(wheel, Path(folder))
    print(f"{wheel.name} works without a compiler")


if __name__ == "__main__":
    main()

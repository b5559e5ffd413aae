"""The fault matrix: faults put into good logs and robot files of the twin, and what comes of each.

    python benchmarks/faults.py --robot hrp2
    python benchmarks/faults.py --robot hrp2 --logs walks --only timing

Each fault goes the user's way: robot file, URDF and logs are written to files and read again. A number is wrong where
it is off by more than 2 % (stiffness) or 10 % (damping) and its 95 % interval misses the truth.

    SILENT WRONG   a wrong number is called usable
    TRACEBACK      no result and no line that says why
    unnamed        refused or not usable, but the right reason is not given
    caught         refused, or nothing wrong is usable, with the right reason
    warned         the numbers are right, and the fault is told of
    harmless       the numbers are right, nothing is said
"""

from __future__ import annotations

import argparse
import os
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path

from fault_case import Case, Fault
from fault_list import FAULTS
from fault_scoring import Answer, Score, score, totals
from fault_twins import CAMPAIGN, ROBOTS, WALKS, Truth, healthy, read_case
from plantar.feet.identify import identify_feet
from plantar.logs.readers import open_log
from plantar.results.feet import FeetResult
from plantar.robot.model import load_robot

SEEDS = (0, 1, 2, 3)  # of the sensors: the faults go into the first one's logs
MOTIONS = {"campaign": CAMPAIGN, "walks": WALKS}
DEFAULT_FOLDER = Path(tempfile.gettempdir()) / "plantar_faults"


def identified(case: Case) -> Answer:
    """What `plantar identify feet` comes to on a case: a result without its residuals, or what was raised."""
    with tempfile.TemporaryDirectory() as folder:
        try:
            file, logs = case.write(Path(folder))
            robot = load_robot(file)
            result = identify_feet(robot, [open_log(path, robot) for path in logs])
        except Exception as error:
            return error
    return replace(result, residuals=None)


def tried(fault: Fault, case: Case) -> tuple[Answer, float]:
    start = time.perf_counter()
    answer = identified(fault.change(case))
    return answer, time.perf_counter() - start


def _tried_by_name(job: tuple[str, Case]) -> tuple[Answer, float]:
    """For other processes, to which no function can be sent."""
    name, case = job
    return tried(next(fault for fault in FAULTS if fault.name == name), case)


def matrix(
    faults: Sequence[Fault], case: Case, truth: Truth, jobs: int, usual: FeetResult
) -> list[tuple[Fault, Score]]:
    """Every fault's score, told as it comes."""
    found = []
    work = [(fault.name, case) for fault in faults]
    with ProcessPoolExecutor(jobs) if jobs > 1 else _InPlace() as pool:
        for fault, (answer, seconds) in zip(faults, pool.map(_tried_by_name, work), strict=True):
            found.append((fault, score(fault, answer, truth, usual)))
            tell(*found[-1], seconds)
    return found


class _InPlace:
    """A pool of this process alone."""

    def __enter__(self) -> _InPlace:
        return self

    def __exit__(self, *_: object) -> None:
        return None

    map = staticmethod(map)


def tell(fault: Fault, found: Score, seconds: float) -> None:
    """One line of the table."""
    wrong = ", ".join(found.wrong[:3]) + (f" and {len(found.wrong) - 3} more" if len(found.wrong) > 3 else "")
    named = "named" if found.named else ""
    outcome = f"{fault.kind:10} {fault.name[:60]:60} {found.outcome:12} {named:5} {seconds:5.1f} s"
    print(f"{outcome}  {wrong:75} | {found.said[:150]}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--robot", default="hrp2", choices=ROBOTS)
    parser.add_argument("--logs", default="campaign", choices=MOTIONS)
    parser.add_argument("--only", default="", help="faults whose name or kind holds this text")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    parser.add_argument("--out", type=Path, default=DEFAULT_FOLDER, help="where the healthy logs are kept")
    parser.add_argument("--folder", type=Path, help="a folder that `plantar simulate` wrote: take these logs")
    chosen = parser.parse_args()
    if chosen.folder is None:
        cases = healthy(chosen.robot, MOTIONS[chosen.logs], SEEDS, chosen.out)
    else:
        logs = sorted(
            path.with_suffix("").with_suffix(".parquet") for path in chosen.folder.glob("*.truth.json")
        )
        cases = [read_case(chosen.folder / "robot.yaml", logs)]
    case, truth = cases[0]
    usual = identified(case)
    if not isinstance(usual, FeetResult):
        raise usual
    picked = [fault for fault in FAULTS if chosen.only in fault.name or chosen.only in fault.kind]
    found = matrix(picked, case, truth, chosen.jobs, usual)
    if not chosen.only or chosen.only == "healthy":
        for seed, (other, its_truth) in zip(SEEDS[1:], cases[1:], strict=False):
            fault = Fault(f"as recorded, seed {seed}", "healthy", lambda case: case)
            answer, seconds = tried(fault, other)
            found.append((fault, score(fault, answer, its_truth, usual)))
            tell(*found[-1], seconds)
    print(f"\n{chosen.robot}, {chosen.logs}; model of the healthy logs: {usual.model}")
    print("\n".join(totals(found)))


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()

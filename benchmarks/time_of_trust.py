"""What delay and the choice of a law cost, beside spring and damper alone on the same nine recordings.

    python benchmarks/time_of_trust.py

Best of several runs, in CPU seconds (of all threads; what other programs do to the clock does not count) and seconds.
"""

from __future__ import annotations

import argparse
import time

from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.motions.campaign import FIT
from plantar.robot.model import RobotModel
from plantar.twin import PAPER, play_all
from plantar.twin.robots import hrp2

UNSEEN = ("Tilt1", "Squat", "Myrand4", "Myrand5")
WAYS = {
    "spring and damper": FeetSettings(model="kelvin_voigt", wrench_delay=0.0),
    "and delay": FeetSettings(model="kelvin_voigt"),
    "and choice of law": FeetSettings(),
}


def spent(
    robot: RobotModel, logs: list[MotionLog], settings: FeetSettings, times: int
) -> tuple[float, float]:
    """Least CPU seconds and seconds of several runs."""
    runs = []
    for _ in range(times):
        cpu, clock = time.process_time(), time.perf_counter()
        identify_feet(robot, logs[: len(FIT)], logs[len(FIT) :], settings)
        runs.append((time.process_time() - cpu, time.perf_counter() - clock))
    return min(run[0] for run in runs), min(run[1] for run in runs)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--presets", nargs="+", default=["sensors", "realistic"])
    parser.add_argument("--times", type=int, default=3)
    chosen = parser.parse_args()
    robot = hrp2.robot()
    print(f"{'preset':10} {'way':18} {'CPU s':>7} {'s':>6} {'times plain':>12}")
    for preset in chosen.presets:
        (recordings,) = play_all([*FIT, *UNSEEN], robot, PAPER, preset)
        logs = [recording.log for recording in recordings]
        plain = None
        for way, settings in WAYS.items():
            cpu, clock = spent(robot, logs, settings, chosen.times)
            plain = plain or cpu
            print(f"{preset:10} {way:18} {cpu:7.2f} {clock:6.2f} {cpu / plain:12.2f}", flush=True)


if __name__ == "__main__":
    main()

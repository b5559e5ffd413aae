"""`plantar simulate`."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, Option

from plantar.cli.console import options
from plantar.cli.console.terminal import console, end_progress, progress, table
from plantar.errors import PlantarError, needs
from plantar.files import refuse_file
from plantar.results.numbers import number
from plantar.robot.model import load_robot

if TYPE_CHECKING:
    from plantar.twin.bush import Feet

FLEET, FLEET_MOTION, FLEET_PRESET = "fleet", "Tilt3", "sensors"
LONGEST = 10.0  # m: no motion is larger
BUSH_HELP = "Bush of every foot as K_pitch,C_pitch,K_roll,C_roll[,K_z,C_z]; the paper's table 1 if left out."
PRESET_HELP = (
    "Imperfections: ideal, sensors, realistic or harsh; plain_log, what public logs of walking robots hold: 50 Hz, "
    "the root link's attitude, no gyroscope, devices on clocks of their own, force sensors not zeroed; or imperfect: "
    "for each seed a robot that differs from its robot file in masses, mounts, bushes, gains and delays. "
    "realistic if left out."
)


def run(
    motion: Annotated[
        str,
        Argument(
            help="A motion's name, or a table of joint positions of your own (CSV, Parquet); several separated by "
            "commas; 'campaign', the paper's fourteen; 'demo', those of `plantar demo`; or 'fleet'.",
            metavar="MOTION",
        ),
    ],
    out: Annotated[
        Path,
        Option(metavar="DIR", help="Folder for the robot file, the logs and the truth beside them."),
    ],
    preset: Annotated[str | None, Option(metavar="PRESET", help=PRESET_HELP)] = None,
    seed: Annotated[
        int, Option(metavar="N", help="Seed of the sensors' noise, biases and zeros.", min=0)
    ] = 0,
    robot: Annotated[
        Path | None,
        Option(metavar="ROBOT.yaml", help="Robot file of a biped; the HRP-2-like one if left out."),
    ] = None,
    bush: Annotated[str | None, Option(metavar="K,C,...", help=BUSH_HELP)] = None,
    sway: Annotated[
        float | None,
        Option(
            help="How far the chest moves in tilts and where the operator leads it, in m; as in the paper if left out.",
            metavar="M",
        ),
    ] = None,
    vertical: Annotated[
        float | None,
        Option(
            metavar="M",
            help="How far the chest goes down in Tilt4 to Tilt6 and Squat, in m; as in the paper if left out.",
        ),
    ] = None,
    apart: Annotated[
        float | None,
        Option(
            metavar="M",
            help="Distance between the soles, in m; that of the robot's usual posture if left out.",
        ),
    ] = None,
    period: Annotated[
        float | None,
        Option(
            metavar="S", help="Duration of a step of a walk, 0.6 to 6 s; as the walk's name says if left out."
        ),
    ] = None,
    robots: Annotated[int, Option(metavar="N", help="How many robots 'fleet' has.", min=1)] = 20,
    days: Annotated[
        int, Option(metavar="N", help="How many days 'fleet' has: one log per robot and day.", min=1)
    ] = 60,
    quiet: options.Quiet = False,
) -> None:
    """Play motions on the twin, a robot in MuJoCo whose feet are known, and write what it records.

    Motions: Tilt1 to Tilt6, Manual_right_roll, Manual_right_pitch, Manual_left_roll, Manual_left_pitch,
    Manual_both_pitch, Myrand4, Myrand5, Squat. Walks: Walk8, Walk12, Walk16, Walk20 or any other step in cm (1 s a
    step), WalkSlow12 (4 s), WalkQuick12 (0.8 s), WalkTurn, WalkInPlace; Walk12_1, Walk12_2 are trials that land a
    little otherwise. A table of your own, such as `plantar design` writes, holds `time` and `joint.NAME.position`;
    its first row stands on level feet. Each log MOTION.parquet has its truth in MOTION.truth.parquet (bush angles,
    contact forces) and MOTION.truth.json (what was put in). A motion that loses its balance or cannot be reached is
    refused before it is played; one that falls on its bushes, as soon as it does.

    'fleet' writes logs of many robots and days with a manifest for `plantar fleet run`: Tilt3 is played once, each log
    has rubber of its own stiffness and sensors drawn anew (preset 'sensors' if none is given). The first robot's
    rubber ages, the second gets a new sole, a sensor of the third drifts; truth.csv has what was put in.

    Example: plantar simulate Tilt3,Squat --out out/twin --preset sensors --seed 3
    """
    with needs("mujoco", "twin", "plantar simulate"):
        from plantar.motions import CAMPAIGN, DEMO
        from plantar.twin import PAPER, play_all, write_campaign
        from plantar.twin.own_motion import own_plan
        from plantar.twin.presets import DEFAULT
        from plantar.twin.robots import hrp2
    refuse_file(out)
    if motion == FLEET:
        _fleet(out, robots, days, preset, seed, quiet)
        return
    sizes = {"sway": sway, "vertical": vertical, "apart": apart}
    for option, size in sizes.items():
        if size is not None and not 0 < size < LONGEST:
            raise PlantarError(f"--{option} is no length", value=size, valid=f"0 to {LONGEST:g} m")
    chosen = DEFAULT if preset is None else preset
    names = list({"campaign": CAMPAIGN, "demo": DEMO}.get(motion, tuple(motion.split(","))))
    bushes = PAPER if bush is None else _bushes(bush)
    model = None if robot is None else load_robot(robot)
    if model is not None and bush is None and model.name != "hrp2_like":
        message = f"'{model.name}' stands on unknown bushes"
        raise PlantarError(message, valid="--bush K_pitch,C_pitch,K_roll,C_roll")
    report = _reporter(len(names), progress(quiet))
    motions = [own_plan(name, model or hrp2.robot()) if Path(name).suffix else name for name in names]
    (recordings,) = play_all(motions, model, bushes, chosen, [seed], report, **sizes, period=period)
    end_progress(quiet)
    robot_file = write_campaign(out, recordings, model, chosen)
    rows = [
        (one.name, number(one.log.duration), f"{len(one.log)}", f"{out / one.name}.parquet")
        for one in recordings
    ]
    console().print(table(f"{chosen}, seed {seed}", ("motion", "s", "samples", "log"), rows))
    print(robot_file)


def _fleet(out: Path, robots: int, days: int, preset: str | None, seed: int, quiet: bool) -> None:
    from plantar.twin.fleet import write_fleet

    chosen = FLEET_PRESET if preset is None else preset
    step = progress(quiet)
    manifest = write_fleet(out, robots, days, motion=FLEET_MOTION, preset=chosen, seed=seed, progress=step)
    end_progress(quiet)
    console().print(
        f"{robots * days} logs of {robots} robots on {days} days; manifest {manifest}", markup=False
    )


def _bushes(text: str) -> Feet:
    from plantar.twin import Bush

    try:
        values = [float(part) for part in text.split(",")]
        if len(values) not in (4, 6) or not all(0 <= value < 1e9 for value in values):
            raise ValueError
    except ValueError:
        message = "--bush is not four or six numbers that are at least 0"
        raise PlantarError(message, value=text, valid="1000,20,800,16 or 1000,20,800,16,4e5,1000") from None
    return {foot: Bush(*values) for foot in ("left", "right")}


def _reporter(count: int, show: Callable[[str], None]) -> Callable[[str, float], None]:
    """Shows the motions that are playing, from more than one thread, a tenth at a time."""
    lock, done, playing = threading.Lock(), set[str](), dict[str, int]()

    def report(motion: str, share: float) -> None:
        with lock:
            tenth = int(10 * share)
            if share >= 1.0:
                done.add(motion)
                playing.pop(motion, None)
            elif playing.get(motion) == tenth:
                return
            else:
                playing[motion] = tenth
            parts = [f"{name} {10 * part} %" for name, part in playing.items()]
            show(", ".join([f"{len(done)} of {count} motions played", *parts]))

    return report

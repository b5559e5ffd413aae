"""The campaign as one story: play, read back, identify, validate, replay, save."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from threading import Lock
from typing import Any, Final

from plantar.campaign.choice import choice_rows
from plantar.campaign.compared import (
    CrossBeside,
    DirectBeside,
    ParameterBeside,
    cross_beside,
    direct_beside,
    parameters_beside,
)
from plantar.campaign.replay import ReplayRow, candidates, hands_of, record_rows, replay_rows
from plantar.errors import MotionError
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.motions import CAMPAIGN, FIT
from plantar.motions.select_motions import Selection, select_motions
from plantar.notes import Note
from plantar.results.feet import Comparison, FeetResult
from plantar.robot.model import RobotModel, load_robot
from plantar.robot.uncertainty import EXACT
from plantar.twin import PAPER, TwinRecording, play, play_all, write_campaign
from plantar.twin.bush import Feet
from plantar.twin.presets import preset_named
from plantar.twin.replay import Replayed, replay

UNSEEN: Final = ("Tilt1", "Squat", "Myrand4", "Manual_both_pitch")  # the paper's cross-validation
# one offset for the composed motion, a spring and a damper, and sensors that are never late
PAPER_WAY: Final = FeetSettings(offset="shared", model="kelvin_voigt", wrench_delay=0.0)
PAPER_WAY_NAME: Final = "the paper's way: one shared offset, spring and damper, no delay"

Progress = Callable[[str], None]
STEPS: Final = 20  # a line for every five percent


@dataclass(frozen=True)
class Course:
    """Which motions are fitted and which are kept unseen; `replayed` go through the simulator again, on feet
    that are identified, rigid and, by name, guessed."""

    fit: tuple[str, ...] = FIT
    validate: tuple[str, ...] = tuple(name for name in CAMPAIGN if name not in FIT)
    replayed: tuple[str, ...] = UNSEEN
    guesses: tuple[str, ...] | None = None  # None: all

    @classmethod
    def quick(cls) -> Course:
        """Two short motions, to see that everything works: no numbers to lean on."""
        return cls(("Tilt3",), ("Squat",), ("Squat",), ())

    def only(self, motions: Iterable[str]) -> Course:
        """The same without unseen motions that are not among `motions`."""
        kept = set(motions)
        validate, replayed = (
            tuple(n for n in names if n in kept) for names in (self.validate, self.replayed)
        )
        return replace(self, validate=validate, replayed=replayed)

    @property
    def motions(self) -> tuple[str, ...]:
        return (*self.fit, *self.validate)


@dataclass(frozen=True)
class Campaign:
    """Everything a campaign found. `result` is the default pipeline's, its `campaign` holds the rest as data."""

    directory: Path
    robot: RobotModel
    logs: Mapping[str, MotionLog] = field(repr=False)
    result: FeetResult = field(repr=False)
    paper_way: FeetResult = field(repr=False)
    parameters: tuple[ParameterBeside, ...]
    direct: tuple[DirectBeside, ...]
    cross: tuple[CrossBeside, ...]
    selection: Selection = field(repr=False)
    replays: tuple[Replayed, ...] = field(repr=False)
    replayed: tuple[ReplayRow, ...]


def run_campaign(
    directory: Path,
    course: Course | None,
    preset: str,
    seed: int,
    progress: Progress,
) -> Campaign:
    """Play the course on the twin, identify from the files that it wrote, and save `result.json`.

    Logs and robot file go to `directory`/logs; `result.json` and `residuals.parquet` into `directory`. Raises
    PlantarError for an unknown preset or a place that cannot be written.
    """
    course = course or Course()
    logs = directory / "logs"
    recordings, notes = _played(course, preset, seed, progress)
    robot_file = write_campaign(logs, recordings)
    course = course.only(recording.name for recording in recordings)
    del recordings  # what follows knows only what the files say
    progress("read the logs")
    robot = replace(load_robot(robot_file), uncertainty=EXACT)
    loaded = {name: open_log(logs / f"{name}.parquet", robot) for name in course.motions}
    fitted, unseen = ([loaded[name] for name in names] for names in (course.fit, course.validate))
    result = identify_feet(robot, fitted, unseen, progress=progress)
    result = replace(result, notes=(*result.notes, *notes))
    paper_way = identify_feet(robot, fitted, unseen, PAPER_WAY, progress)
    selection = select_motions(robot, list(loaded.values()), course.fit, len(course.fit), progress=progress)
    truth = preset_named(preset).physics(PAPER).bushes or PAPER
    kinds = candidates(result) if course.guesses is None else candidates(result, course.guesses)
    again = [loaded[name] for name in course.replayed]
    count = len(again) * len(kinds)
    report = shares(f"replay {count} times in the simulator", count, progress)
    replays = replay(robot, again, kinds, hands_of(robot, course.replayed), report)
    replayed = replay_rows(replays, course.replayed, tuple(kinds)) + record_rows(robot, again, preset, PAPER)
    campaign = Campaign(
        directory, robot, loaded, result, paper_way,
        parameters_beside(result, paper_way, truth), direct_beside(result, paper_way), cross_beside(result, paper_way),
        selection, tuple(replays), replayed,
    )  # fmt: skip
    progress("save the numbers")
    beside = Comparison(PAPER_WAY_NAME, paper_way.settings, paper_way.parameters, paper_way.validation)
    result = replace(result, comparisons=(beside,), campaign=_as_data(campaign, preset, seed, truth))
    campaign = replace(campaign, result=result)
    campaign.result.save(directory)
    return campaign


def _played(
    course: Course, preset: str, seed: int, progress: Progress
) -> tuple[list[TwinRecording], list[Note]]:
    """Recordings of the course; an unseen motion in which the robot falls is left out with a warning.

    Raises MotionError where the robot falls in a motion that the fit needs.
    """
    count = len(course.motions)
    report = shares(f"play {count} motions on the twin", count, progress)
    try:
        return play_all(course.motions, None, PAPER, preset, [seed], report)[0], []
    except MotionError:
        recordings, notes = [], []  # what was rolled out lies in the cache
        for name in course.motions:
            try:
                recordings.append(play(name, None, PAPER, preset, seed))
            except MotionError as error:
                if name in course.fit:
                    raise
                notes.append(Note("motion_left_out", "warning", f"left out: {error}"))
        return recordings, notes


def _as_data(campaign: Campaign, preset: str, seed: int, truth: Feet) -> dict[str, Any]:
    """What `result.json` keeps under `campaign`."""
    return {
        "preset": preset,
        "seed": seed,
        "truth": {foot: vars(bush) for foot, bush in truth.items()},
        "table_1": [asdict(row) for row in campaign.parameters],
        "table_2": [asdict(row) for row in campaign.direct],
        "table_3": [asdict(row) for row in campaign.cross],
        "selection": choice_rows(campaign.selection),
        "replay": [asdict(row) for row in campaign.replayed],
    }


def shares(what: str, count: int, progress: Callable[[str], None]) -> Callable[[str, float], None]:
    """A function that takes a job's name and the share of it that is done, from any thread, and says now and then how
    far `count` jobs are together."""
    done: dict[str, float] = {}
    said = -1
    lock = Lock()

    def report(job: str, share: float) -> None:
        nonlocal said
        with lock:
            done[job] = share
            step = int(STEPS * sum(done.values()) / count + 1e-9)
            if step > said:
                said = step
                progress(f"{what}: {100 // STEPS * step} %")

    return report

"""Slip and tipping in known seconds: how well they are found, and what K and C are worth in spite of them.

    python benchmarks/contact.py --presets sensors realistic --seeds 0 1 2 3

Slides, leans and their truth are those of `disturbed`; where both feet stand, both are said to slide when either does.
Samples left out for another reason (air, landing, lifting, impact, a filter's edge) are not scored; "kept out for any
reason" is the share of all samples truly sliding or tipping that do not serve.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from disturbed import Trial, play_disturbed
from plantar.contact.phases import AIR, DOUBLE, joined, widened
from plantar.conventions import ROTATIONAL_AXES
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.identify import identify_feet
from plantar.feet.prepare import prepare_all
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.motions.campaign import FIT
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.signals.segments import runs
from plantar.twin import PAPER
from plantar.twin.play import play_all
from plantar.twin.robots import hrp2

TOLERANCE = 0.1  # s by which an event may be missed at its ends, and a flag may reach beyond one
KINDS = ("slip", "tipping")
PUT_BACK = ("slip", "tipping", "impact", "filter's edge: beside")
Errors = dict[str, list[tuple[float, float]]]


@dataclass
class Count:
    """Samples and events of one kind: found rightly, found wrongly, missed."""

    hits: int = 0
    false: int = 0
    missed: int = 0
    events_hit: int = 0
    events_false: int = 0
    events_missed: int = 0
    true: int = 0
    true_out: int = 0

    @property
    def kept_out(self) -> float:
        return self.true_out / max(self.true, 1)

    def add(self, truth: np.ndarray, flagged: np.ndarray, scored: np.ndarray, reach: int) -> None:
        """Samples as they are; an event counts as found where a flag touches it, widened by `reach` samples."""
        self.hits += int((truth & flagged & scored).sum())
        self.false += int((~truth & flagged & scored).sum())
        self.missed += int((truth & ~flagged & scored).sum())
        near = widened(truth, reach)
        for run in runs(joined(truth & scored, reach)):
            found = flagged[max(0, run.start - reach) : run.stop + reach].any()
            self.events_hit, self.events_missed = (
                self.events_hit + int(found),
                self.events_missed + int(not found),
            )
        for run in runs(joined(flagged & scored, reach)):
            self.events_false += not near[run].any()

    def text(self) -> str:
        shares = (
            self.hits / max(self.hits + self.false, 1),
            self.hits / max(self.hits + self.missed, 1),
            self.events_hit / max(self.events_hit + self.events_false, 1),
            self.events_hit / max(self.events_hit + self.events_missed, 1),
        )
        return "".join(f"{share:10.3f}" for share in shares) + f"{self.events_hit + self.events_missed:8d}"


def score(result: FeetResult, robot: RobotModel, trials: Sequence[Trial], counts: dict[str, Count]) -> None:
    """Compare the reasons of a result's phases with what the soles did."""
    for trial in trials:
        time, period = trial.log.time, trial.log.period
        reach = round(TOLERANCE / period)
        for foot in robot.feet:
            truth = {kind: trial.truth[foot, kind].copy() for kind in KINDS}
            any_slips = np.any([trial.truth[other, "slip"] for other in robot.feet], axis=0)
            flagged = {kind: np.zeros(time.size, dtype=bool) for kind in KINDS}
            # The last sample ends a phase and belongs to none.
            scored, served, standing = (np.zeros(time.size, dtype=bool) for _ in range(3))
            for phase in result.phases:
                if (phase.motion, phase.foot) != (trial.log.name, foot):
                    continue
                rows = (time >= phase.start - period / 2) & (time < phase.end - period / 2)
                kind = (phase.reason or "").split(":")[0]
                if kind in flagged:
                    flagged[kind] |= rows
                scored[rows] = kind in flagged or phase.reason is None
                served[rows] = phase.used
                standing[rows] = phase.support != AIR
                if phase.support == DOUBLE:
                    truth["slip"][rows] = any_slips[rows]
            # A sole that slides and tips at once is left out once: either reason is right.
            both = truth["slip"] & truth["tipping"]
            either = both & (flagged["slip"] | flagged["tipping"])
            for kind in KINDS:
                counts[kind].add(truth[kind], flagged[kind] | either, scored, reach)
                counts[kind].true += int((truth[kind] & standing).sum())
                counts[kind].true_out += int((truth[kind] & standing & ~served).sum())


def with_everything(robot: RobotModel, logs: Sequence[MotionLog], others: Sequence[MotionLog]) -> Errors:
    """Errors of K and C where slip, tipping and impacts are put back into the fit."""
    settings = FeetSettings()
    ready = prepare_all(robot, logs, others, settings, lambda _: None)
    for recording in ready.fitted:
        for contact in recording.contacts.values():
            back = [
                k
                for k, reason in enumerate(contact.reasons)
                if reason is not None and reason.text.startswith(PUT_BACK)
            ]
            contact.code[np.isin(contact.code, back)] = 0
    found: Errors = {"K": [], "C": []}
    for foot in robot.feet:
        for axis in ROTATIONAL_AXES:
            fit = fit_axis(ready.fitted, foot, axis, settings)
            assert fit is not None
            for place, (name, term) in enumerate((("K", "stiffness"), ("C", "damping"))):
                truth = getattr(PAPER[foot], f"{axis}_{term}")
                found[name].append((fit.values[place] / truth - 1, float("nan")))
    return found


def parameter_errors(result: FeetResult) -> Errors:
    """Error of each K and C relative to the truth, and whether its interval covers it."""
    found: Errors = {"K": [], "C": []}
    for row in result.parameters:
        name = {"stiffness": "K", "damping": "C"}.get(row.name)
        if name is None or row.axis == "z" or row.value is None or row.interval95 is None:
            continue
        truth = getattr(PAPER[row.foot], f"{row.axis}_{row.name}")
        found[name].append((row.value / truth - 1, row.interval95[0] <= truth <= row.interval95[1]))
    return found


def print_table(preset: str, counts: dict[str, Count], errors: Errors, left_out: dict[str, float]) -> None:
    heads = "".join(f"{head:>10}" for head in 2 * ("precision", "recall"))
    print(f"\n{preset}\n{'':10}{'by sample':>20}{f'by event, {TOLERANCE:g} s':>20}\n{'':10}{heads}  events")
    for kind in KINDS:
        print(f"{kind:10}{counts[kind].text()}  kept out for any reason {counts[kind].kept_out:.3f}")
    for label, rows in errors.items():
        relative, covered = np.array(rows, dtype=float).T
        sizes = f"median |error| {100 * np.median(abs(relative)):5.2f} %, largest {100 * abs(relative).max():6.2f} %"
        share = "" if np.isnan(covered).all() else f", {100 * covered.mean():.0f} % of {len(rows)} covered"
        print(f"{label:22} {sizes}{share}")
    print("seconds of standing feet: " + ", ".join(f"{why} {spent:.0f}" for why, spent in left_out.items()))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--presets", nargs="+", default=["sensors", "realistic", "harsh"])
    parser.add_argument("--seeds", type=int, nargs="+", default=[0, 1, 2])
    parser.add_argument("--motions", nargs="+", default=list(FIT))
    parser.add_argument("--others", nargs="*", default=["Myrand5"], help="to validate, with slippery seconds")
    parser.add_argument("--calm", nargs="*", default=["Myrand4"], help="to validate, undisturbed: the delay")
    chosen = parser.parse_args()
    robot = hrp2.robot()
    for preset in chosen.presets:
        counts: dict[str, Count] = defaultdict(Count)
        errors: Errors = defaultdict(list)
        seconds: dict[str, float] = defaultdict(float)
        for seed in chosen.seeds:
            trials = play_disturbed(chosen.motions, chosen.others, robot, preset, seed)
            calm = play_all(chosen.calm, robot, PAPER, preset, [seed])[0]
            logs = [trial.log for trial in trials]
            split = len(chosen.motions)
            fitted, unseen = logs[:split], [*logs[split:], *(recording.log for recording in calm)]
            result = identify_feet(robot, fitted, unseen)
            score(result, robot, trials, counts)
            for phase in result.phases:
                if phase.support != AIR:
                    seconds[(phase.reason or "served").split(":")[0]] += phase.end - phase.start
            for label, rows in (
                ("", parameter_errors(result)),
                (" with everything", with_everything(robot, fitted, unseen)),
            ):
                for name in ("K", "C"):
                    errors[name + label] += rows[name]
        print_table(preset, counts, errors, seconds)


if __name__ == "__main__":
    main()

"""`plantar design`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from typer import Argument, BadParameter, Option

from plantar.choices import one_of
from plantar.cli.console import options
from plantar.cli.console.terminal import (
    console,
    end_progress,
    print_json,
    print_notes,
    progress,
    table,
)
from plantar.errors import PlantarError, needs
from plantar.files import write_text
from plantar.logs.save import save_log
from plantar.notes import Note
from plantar.results.feet import FeetResult
from plantar.results.io import dump_json
from plantar.results.numbers import number
from plantar.robot.model import load_robot

if TYPE_CHECKING:
    from collections.abc import Callable

    from plantar.robot.model import RobotModel


def run(
    robot: Annotated[Path, Argument(help="Robot file (YAML) of a biped.", metavar="ROBOT.yaml")],
    out: Annotated[
        Path,
        Option(
            metavar="MOTION.csv",
            help="CSV of the motion. A JSON file with the predicted intervals, a page and a preview go beside it.",
        ),
    ],
    stiffness: Annotated[
        float | None,
        Option(
            metavar="K",
            help="Stiffness of each foot in pitch and roll, as far as you know it, in N·m/rad. Give this or --after.",
        ),
    ] = None,
    after: Annotated[
        Path | None,
        Option(
            help="An earlier result: its stiffness is used, and the motion is made for what is weak in it.",
            metavar="RESULT.json",
        ),
    ] = None,
    damping: Annotated[
        float | None,
        Option(
            metavar="C",
            help="Damping in N·m·s/rad, for the prediction; 0.04 s times the stiffness if left out.",
        ),
    ] = None,
    duration: Annotated[float, Option(metavar="S", help="Duration of the motion, in s.")] = 60.0,
    rate: Annotated[float, Option(metavar="HZ", help="Rows per second in the file, in Hz.")] = 200.0,
    criterion: Annotated[
        str,
        Option(
            metavar="CRITERION",
            help="What the search makes small: 'widest', the widest relative interval; or, of all parameters "
            "together, D (their volume) or A (their mean square).",
        ),
    ] = "widest",
    seed: Annotated[
        int, Option(metavar="N", help="Seed of the random frequencies and of the search.", min=0)
    ] = 0,
    to: Annotated[
        list[str] | None,
        Option(
            metavar="FORMAT",
            help="Also for a controller: ros (JointTrajectory as YAML), mcap (in a bag), openhrp (.pos), "
            "mc_rtc (.bin, for its Replay plugin).",
        ),
    ] = None,
    approach: Annotated[
        bool,
        Option("--approach", help="Also versions with 25 and 50 % of the amplitude, to play first."),
    ] = False,
    like: Annotated[
        str | None,
        Option(
            metavar="MOTIONS", help="'campaign': for comparison, the best of the paper's fourteen motions."
        ),
    ] = None,
    json: options.Json = False,
    quiet: options.Quiet = False,
) -> None:
    """Make a motion that identifies the feet as well as balance and joint limits allow,
    even if the stiffness is half or twice what you say.

    MOTION.csv holds `time` and the position of every joint of the URDF, from standing still to standing still.
    MOTION.json holds the half widths it predicts, the balance margins and the limits it kept; MOTION.md says the same
    on a page for those who stand beside the robot, MOTION.html shows the robot move, the angles of its bushes enlarged.

    Example: plantar design robot.yaml --stiffness 500 --out motion.csv
    """
    with needs("mujoco", "twin", "plantar design"):
        from plantar.campaign.scene import write_plan_scene
        from plantar.design.story import DesignSettings, design_motion
        from plantar.design.writing.outputs import check_outputs, write_design
    if out.suffix.lower() != ".csv":
        raise PlantarError("has an unknown ending", path=out, valid=".csv")
    model = load_robot(robot)
    check_outputs(model, rate, to or ())
    settings = DesignSettings(stiffness, damping, duration, criterion, seed)  # type: ignore[arg-type]
    step = progress(quiet)
    if stiffness is None and (after is None or like is not None):
        raise BadParameter("tell --stiffness, or an earlier result with --after")
    earlier = None if after is None else FeetResult.load(after, residuals=False)
    if like is not None:
        one_of("--like", like, ("campaign",))
        _of_the_paper(model, stiffness, damping, out, rate, json, step)
        end_progress(quiet)
        return
    found = design_motion(model, settings, earlier, step)
    step("write")
    content = write_design(found, out, rate, to or (), approach)
    write_plan_scene(found.robot, found.trajectory.plan(), found.nominal.bushes, out.with_suffix(".html"))
    end_progress(quiet)
    if json:
        print_json(**content)
        return
    screen = console()
    rows = [
        (row["foot"], row["axis"], row["name"], number(row["half_width_percent"], 3),
         *(number(one["half_width_percent"], 3) for one in row["at"]))
        for row in content["parameters"]
    ]  # fmt: skip
    factors = [f"x{one['factor']:.3g}" for one in content["rehearsals"]]
    screen.print(table("95 % half widths that it predicts [% of the value]",
                       ("foot", "axis", "parameter", "predicted", *factors), rows))  # fmt: skip
    rows = [
        (f"x{one['factor']:.3g}", number(1e3 * one["sole_margin"], 3), number(100 * one["least_load"], 3),
         number(one["friction"], 2), number(100 * one["effort"], 3), number(one["bend"], 2))
        for one in content["rehearsals"]
    ]  # fmt: skip
    margin, torque = "margin on the soles [mm]", "torque [% of limit]"
    heads = ("stiffness", margin, "least load [%]", "friction", torque, "bend [rad]")
    screen.print(table("\nRehearsed", heads, rows))
    print_notes(screen, [Note("rehearsal", "warning", text) for text in content["notes"]])
    for ending in (".csv", ".json", ".md", ".html"):
        screen.print(str(out.with_suffix(ending)), markup=False)


def _of_the_paper(
    robot: RobotModel,
    stiffness: float | None,
    damping: float | None,
    out: Path,
    rate: float,
    json: bool,
    step: Callable[[str], None],
) -> None:
    """`--like campaign`."""
    from plantar.design.paper_motions import paper_motions
    from plantar.design.soft_feet import Softness

    assert stiffness is not None, "asked for above"
    found = paper_motions(robot, Softness.told(robot, stiffness, damping), step)
    best_set = found.selection.best[-1].motions
    content = {
        "schema": "plantar.design/1", "robot": robot.name, "motion": out.name, "like": "campaign",
        "best": found.best.name, "best_set": best_set, "parameters": found.half_widths(), "refused": found.refused,
    }  # fmt: skip
    save_log(found.log(rate), out)
    write_text(out.with_suffix(".json"), dump_json(content))
    if json:
        print_json(**content)
        return
    names, widths = ("foot", "axis", "name"), ("percent", "best_set_percent")
    rows = [
        (*(str(row[key]) for key in names), *(f"{row[key]:.3g}" for key in widths))
        for row in found.half_widths()
    ]
    screen = console()
    title = "95 % half widths as `plantar select` gives them [% of the value]: one motion, and the best set"
    screen.print(table(title, ("foot", "axis", "parameter", found.best.name, "best set"), rows))
    screen.print(f"The best set: {', '.join(best_set)}.\n{out}\n{out.with_suffix('.json')}", markup=False)

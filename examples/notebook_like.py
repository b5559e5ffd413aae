# %% [markdown]
# # The feet of a robot, from its logs
# Run cell by cell in an editor that knows `# %%`, or as a whole: `python examples/notebook_like.py FOLDER`.
# FOLDER holds `robot.yaml` and logs; it is the current one where left out. `plantar simulate Tilt3,Squat --out FOLDER`
# makes some.

# %%
import sys
from pathlib import Path

import plantar

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
files = sorted(
    path for path in folder.iterdir() if path.suffix in (".csv", ".parquet") and ".truth" not in path.name
)
robot = plantar.load_robot(folder / "robot.yaml")

# %% [markdown]
# The last log is kept unseen. Settings are checked when they are made: `FeetSettings(model="x")` names the valid ones.

# %%
settings = plantar.FeetSettings(model="auto", cutoff=5.0)
result = plantar.identify_feet(robot, files[:-1], validate=files[-1:], settings=settings)
print(result)

# %% [markdown]
# Numbers are typed rows; as a table they go to pandas or polars.

# %%
foot = next(iter(robot.feet))
row = result.parameter(foot, "pitch", "stiffness")
print(f"{foot} pitch: {row.value:.0f} {row.unit}, 95 % in {row.interval95}, {row.verdict}: {row.reason}")
for model in result.models:
    print(f"{model.foot} {model.axis}: {model.model}, {model.reason}")
table = result.to_table()
print(table.select(["foot", "axis", "name", "value", "low", "high"]).slice(0, 4))

# %% [markdown]
# Torque over angle: a loop says that energy is lost, a bend that the spring is not linear.

# %%
axes = result.plot(foot, "pitch")
axes.figure.savefig(folder / "pitch.png")

# %% [markdown]
# Save, load again, score another log, hand over to a simulator.

# %%
saved = result.save(folder / "feet")
again = plantar.FeetResult.load(saved)
for score in plantar.validate_feet(again, robot, files[-1]):
    print(
        f"{score.foot} {score.axis}: {score.mean_abs_error:.3g} N·m, offset alone {score.zero_mean_abs:.3g} N·m"
    )
for note in plantar.export(again, "mjcf", folder / "robot_on_bushes.xml"):
    print(note.text)

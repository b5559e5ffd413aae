"""The robot file as text: every line that was guessed says so, by how much it may be off, and why."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields

import numpy as np
import yaml

from plantar.robot.joint_names import JointNames
from plantar.robot.uncertainty import Uncertainty
from plantar.robot_guess.evidence import Remark
from plantar.robot_guess.feet import Sole, placement, vector
from plantar.robot_guess.imu import Mount
from plantar.robot_guess.seat import Seat


@dataclass(frozen=True)
class BushHeight:
    """Of a bush over the ankle's origin in the foot's axes, and by how much it may be off [m]; its reason."""

    height: float
    spread: float
    reason: str


@dataclass(frozen=True)
class Draft:
    """All that goes into a first robot file. `imu`: its name and mount; by side: sensors' names, seats, bushes;
    `numbered`: the logs only number the joints, and `names` takes them in the URDF's order."""

    name: str
    source: str
    imu: tuple[str, Mount] | None
    soles: Sequence[Sole]
    sensors: Mapping[str, str]
    seats: Mapping[str, Seat]
    bushes: Mapping[str, BushHeight]
    names: JointNames
    topics: Mapping[str, str]
    remarks: Sequence[Remark]
    numbered: bool = False

    def sensor(self, sole: Sole) -> str:
        """What a foot's force sensor is called: as its side where the logs do not tell."""
        return self.sensors.get(sole.limb.side, sole.limb.side)

    def text(self, urdf: str) -> str:
        """The file, with `urdf` as its path."""
        lines = [
            f"# Written by plantar init from {self.source}.",
            "# Lines marked GUESS are not measured; ± says how far off they may be. Measure, then delete the mark.",
            *(f"# {'DOUBT' if remark.doubt else 'Seen'}: {remark.text}" for remark in self.remarks),
            f"name: {scalar(self.name)}",
            f"urdf: {scalar(urdf)}",
            "# mass: ...  # kg: weigh the robot, with battery and cover, if you can",
            *self._imu(),
            "feet:",
        ]
        for sole in self.soles:
            lines += self._foot(sole)
        if entry := self.names.entry():
            if self.numbered:
                lines.append(
                    "# GUESS: the logs only number the joints; taken in the URDF's order, look it up"
                )
            lines += yaml.safe_dump({"joint_names": entry}, sort_keys=False, width=10_000).splitlines()
        if self.topics:
            lines.append("topics:")
            lines += [f"  {scalar(key)}: {scalar(topic)}" for key, topic in self.topics.items()]
        lines.append("# uncertainty:  # standard deviations; these are the defaults")
        for one in fields(Uncertainty):
            lines.append(f"#   {one.name}: {one.default}  # {one.metadata['meaning']}")
        return "\n".join(lines) + "\n"

    def _imu(self) -> list[str]:
        if self.imu is None:
            return ["# imu: no IMU was found in the logs"]
        name, mount = self.imu
        rpy = mount.rpy
        turn = f", rpy: {vector(rpy)}" if np.abs(rpy).max() > 1e-3 else ""
        if not mount.guess:
            return [
                f"imu: {{name: {scalar(name)}, link: {scalar(mount.link)}{turn}}}  # link: {mount.reason}"
            ]
        also = f"; or one of {', '.join(mount.others)}" if mount.others else ""
        place = f"{{name: {scalar(name)}, link: {scalar(mount.link)}, xyz: [0, 0, 0]{turn}}}"
        return [f"imu: {place}  # GUESS{_spread(mount.spread)}: {mount.reason}{also}"]

    def _foot(self, sole: Sole) -> list[str]:
        side, seat, bush = sole.limb.side, self.seats[sole.limb.side], self.bushes[sole.limb.side]
        link = f", link: {scalar(seat.link)}" if seat.link != sole.limb.link or not seat.guess else ""
        pose = "" if not seat.guess else f", {placement(seat.xyz, seat.rotation)}"
        sign = ", sign: -1" if seat.sign < 0 else ""
        why = "; sign: its force points down under load" if sign else ""
        if seat.guess:
            evidence = f"GUESS{_spread(seat.spread)}: {seat.reason}{why}"
        else:
            evidence = f"link: {seat.reason}{why}"
        corners = ", ".join(vector(corner) for corner in np.round(sole.corners, 4))
        depth = sole.place(round(sole.depth, 4))
        within = f"± {_mm(sole.outline_spread)} mm in the outline, ± {_mm(sole.spread)} mm in height"
        return [
            f"  {side}:",
            f"    ankle: {scalar(sole.limb.link)}",
            f"    bush: {{{sole.place(round(bush.height, 4))}}}  # GUESS{_spread(bush.spread)}: {bush.reason}",
            f"    wrench: {{name: {scalar(self.sensor(sole))}{link}{pose}{sign}}}  # {evidence}",
            f"    # GUESS {within}: {sole.reason}",
            f"    sole: {{{depth}, polygon: [{corners}]}}",
        ]


def scalar(value: str) -> str:
    """A scalar as YAML, quoted where it must be."""
    written = yaml.safe_dump(value, default_flow_style=True, width=10_000)
    return written.removesuffix("\n").removesuffix("...").strip()


def _spread(size: float) -> str:
    return f" ± {_mm(size)} mm" if size else ""


def _mm(size: float) -> str:
    return f"{1e3 * size:.0f}"

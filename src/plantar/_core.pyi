"""Types of the native core; its arrays are float64."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from plantar.conventions import Array

def instruction_sets() -> list[str]: ...
def foot_chain(
    frames: Sequence[Array],
    slides: Sequence[bool],
    signs: Sequence[float],
    bush: Array,
    sole: Array,
    positions: Sequence[Array],
    velocities: Sequence[Array],
    orientation: Array,
    angular_velocity: Array,
    threads: int = 0,
    isa: str = "",
) -> Array: ...
def sole_load(
    sensor: Array,
    sign: float,
    wrench: Array,
    up: Array,
    sole: Array,
    least: float,
    threads: int = 0,
    isa: str = "",
) -> Array: ...

class Tree:
    def __init__(
        self,
        parents: Sequence[int],
        slides: Sequence[bool],
        axes: Sequence[Array],
        frames: Sequence[Array],
        floating: bool,
    ) -> None: ...

class Stream:
    def __init__(
        self, tree: Tree, kept: Sequence[int], extras: Sequence[int], groups: Sequence[int]
    ) -> None: ...
    def add(
        self,
        base: Array,
        q: Array,
        v: Array,
        a: Array,
        extras: Sequence[Sequence[Array]],
        threads: int = 0,
        isa: str = "",
    ) -> None: ...
    def factor(self, group: int) -> Array: ...
    def parameters(self, group: int) -> list[int]: ...

def root_motion(
    tree: Tree,
    link: int,
    place: Array,
    measured: Array,
    q: Array,
    v: Array,
    a: Array,
    threads: int = 0,
    isa: str = "",
) -> Array: ...
def base_transfer(
    tree: Tree, link: int, place: Array, positions: Array, threads: int = 0, isa: str = ""
) -> Array: ...
def regressor(
    tree: Tree,
    kept: Sequence[int],
    rows: Sequence[bool],
    base: Array,
    q: Array,
    v: Array,
    a: Array,
    threads: int = 0,
    isa: str = "",
) -> Array: ...
def inverse_dynamics(
    tree: Tree,
    parameters: Array | None,
    links: Sequence[int],
    frames: Sequence[Array],
    wrenches: Sequence[Array],
    base: Array,
    q: Array,
    v: Array,
    a: Array,
    threads: int = 0,
    isa: str = "",
) -> Array: ...
def base_wrenches(
    tree: Tree, parameters: Array, base: Array, q: Array, v: Array, a: Array, threads: int = 0, isa: str = ""
) -> Array: ...
def stacked(
    factors: Sequence[Array], onto: Sequence[Sequence[int]], weights: Sequence[float], n: int
) -> Array: ...
def smooth_drift(
    weight: Array, jump: Array, wander: float, period: float, first: tuple[float, float], values: Array
) -> Array: ...
def drift_variance(
    weight: Array, jump: Array, wander: float, period: float, first: tuple[float, float]
) -> Array: ...

class FootEstimator:
    def __init__(self, model: str) -> None: ...
    def step(
        self,
        time: float,
        position: Array,
        velocity: Array | None,
        attitude: Array | None,
        angular_velocity: Array | None,
        acceleration: Array | None,
        wrench: Array,
        out: Array,
    ) -> None: ...
    def replay(
        self,
        time: Array,
        position: Array,
        velocity: Array | None,
        attitude: Array | None,
        angular_velocity: Array | None,
        acceleration: Array | None,
        wrench: Array,
        out: Array,
        latency: Array,
    ) -> None: ...

def low_pass(
    values: Array, out: Array, cutoff: float, padding: int, shortest: int, every: int = 1
) -> None: ...
def numbers_into(text: bytes, places: list[int], values: Array, first: int) -> int | None: ...
def stop_operator(
    direction: Array, length: Array, branch: NDArray[np.int64], travelled: Array, slip: Array, start: Array
) -> Array: ...
def inverse_upper(upper: Array) -> Array: ...

STEPPING_SOURCE: str

class Stepping:
    def __init__(
        self,
        step: int,
        model: int,
        data: int,
        positions: Array,
        applied: Array,
        control: Array,
        places: Sequence[tuple[int, int]],
        laws: Sequence[tuple[float, float, float]],
    ) -> None: ...
    def run(self, rows: Array) -> None: ...

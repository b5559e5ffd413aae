"""Types of the native core; its arrays are float64."""

from collections.abc import Sequence

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

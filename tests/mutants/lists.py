"""Every list of mutants, by the name that `run.py --list` takes."""

from __future__ import annotations

from at_their_edges import AT_THEIR_EDGES
from by_hand import BY_HAND
from data_faults import DATA_FAULTS
from designed_motions import DESIGNED_MOTIONS
from drawn import DRAWN
from drawn_afresh import DRAWN_AFRESH
from drawn_again import DRAWN_AGAIN
from drawn_anew import DRAWN_ANEW
from drawn_at_random import DRAWN_AT_RANDOM
from drawn_blind import DRAWN_BLIND
from drawn_by_hand import DRAWN_BY_HAND
from drawn_by_lot import DRAWN_BY_LOT
from drawn_everywhere import DRAWN_EVERYWHERE
from drawn_last import DRAWN_LAST
from drawn_once_more import DRAWN_ONCE_MORE
from drawn_twice import DRAWN_TWICE
from engine_exports import ENGINE_EXPORTS
from fleet_statistics import FLEET
from handed_on import HANDED_ON
from in_their_place import IN_THEIR_PLACE
from kept_outputs import KEPT
from kept_parts import KEPT_PARTS
from literal_edges import LITERAL_EDGES
from made_cheaper import MADE_CHEAPER
from of_their_kinds import OF_THEIR_KINDS
from once_unnoticed import ONCE_UNNOTICED
from other_robots import OTHER_ROBOTS
from seldom_run import SELDOM_RUN
from sensor_faults import SENSOR_FAULTS
from shared_work import SHARED_WORK
from soles_and_freedom import SOLES_AND_FREEDOM
from standing_soles import STANDING_SOLES
from unlisted import UNLISTED

LISTS = {
    "drawn": DRAWN,
    "drawn_again": DRAWN_AGAIN,
    "drawn_anew": DRAWN_ANEW,
    "drawn_everywhere": DRAWN_EVERYWHERE,
    "of_their_kinds": OF_THEIR_KINDS,
    "once_unnoticed": ONCE_UNNOTICED,
    "made_cheaper": MADE_CHEAPER,
    "shared_work": SHARED_WORK,
    "data_faults": DATA_FAULTS,
    "sensor_faults": SENSOR_FAULTS,
    "designed_motions": DESIGNED_MOTIONS,
    "fleet": FLEET,
    "engine_exports": ENGINE_EXPORTS,
    "handed_on": HANDED_ON,
    "at_their_edges": AT_THEIR_EDGES,
    "drawn_last": DRAWN_LAST,
    "drawn_once_more": DRAWN_ONCE_MORE,
    "drawn_by_lot": DRAWN_BY_LOT,
    "drawn_blind": DRAWN_BLIND,
    "literal_edges": LITERAL_EDGES,
    "drawn_afresh": DRAWN_AFRESH,
    "standing_soles": STANDING_SOLES,
    "other_robots": OTHER_ROBOTS,
    "unlisted": UNLISTED,
    "drawn_at_random": DRAWN_AT_RANDOM,
    "soles_and_freedom": SOLES_AND_FREEDOM,
    "seldom_run": SELDOM_RUN,
    "in_their_place": IN_THEIR_PLACE,
    "by_hand": BY_HAND,
    "kept_outputs": KEPT,
    "kept_parts": KEPT_PARTS,
    "drawn_by_hand": DRAWN_BY_HAND,
    "drawn_twice": DRAWN_TWICE,
}

"""Motions that make the bushes move: planned with whole-body inverse kinematics, feet where they stand or step."""

from plantar.motions.campaign import CAMPAIGN, DEMO, FIT, Postures, plan_motion, planned_balance
from plantar.motions.gait import WALKS
from plantar.motions.plan import Hand, Plan, Walk

__all__ = [
    "CAMPAIGN",
    "DEMO",
    "FIT",
    "WALKS",
    "Hand",
    "Plan",
    "Postures",
    "Walk",
    "plan_motion",
    "planned_balance",
]

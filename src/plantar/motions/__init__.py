"""Motions that make the bushes move: planned with whole-body inverse kinematics, feet where they stand."""

from plantar.motions.campaign import CAMPAIGN, DEMO, FIT, Postures, plan_motion, planned_balance
from plantar.motions.plan import Hand, Plan

__all__ = ["CAMPAIGN", "DEMO", "FIT", "Hand", "Plan", "Postures", "plan_motion", "planned_balance"]

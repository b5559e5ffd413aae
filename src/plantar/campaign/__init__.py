"""The paper's campaign from the first posture to the last table, on the built-in twin."""

from plantar.campaign.run import Campaign, Course, run_campaign

__all__ = ["Campaign", "Course", "run_campaign"]

"""A look at logs before anything is fitted for good: what is in them, what is wrong, what they can identify."""

from plantar.inspection.log_summary import LogSummary, inspect_log

__all__ = ["LogSummary", "inspect_log"]

"""Delays between sensors, told by what both say of one motion."""

"""Robots of the twin: links, masses, feet cut at the bush."""

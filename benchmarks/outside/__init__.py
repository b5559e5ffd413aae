"""Worlds in plain MuJoCo, made without plantar's twin: other robots, other motions, other equations."""

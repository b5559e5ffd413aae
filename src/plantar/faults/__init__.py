"""Faults of sensors, logs and robot files, each found and named before anything is fitted."""

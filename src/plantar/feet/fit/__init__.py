"""The regressions of one foot."""

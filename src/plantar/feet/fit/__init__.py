"""The fit of one axis, what is put right of it, and what it may hide."""

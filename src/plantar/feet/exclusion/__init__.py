"""Which samples are left out, and why."""

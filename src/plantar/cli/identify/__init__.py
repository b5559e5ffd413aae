"""`plantar identify`: feet, inertia, joints, and the tables that they print."""

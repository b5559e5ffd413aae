"""URDF: the tree, bush joints, identified inertias."""

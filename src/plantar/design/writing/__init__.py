"""What a design leaves on disk."""

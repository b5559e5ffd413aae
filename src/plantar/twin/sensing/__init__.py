"""What the twin's sensors read: exact columns, then noise and delay."""

"""What may be believed of a fit: scores, verdicts, what limits a number."""

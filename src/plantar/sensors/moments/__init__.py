"""What sensors get wrong, told by moments that do not balance: rows of Newton's law, one log, all logs together."""

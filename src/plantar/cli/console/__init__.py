"""What commands share on the terminal: tables, progress, advice."""

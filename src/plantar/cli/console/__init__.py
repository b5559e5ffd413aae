"""What commands share: options, and tables and progress on the terminal."""

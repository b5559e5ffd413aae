"""What commands share: tables and progress on the terminal, the option that bounds memory."""

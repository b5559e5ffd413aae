"""How late each sensor is, told by Newton's law: searched, refined, and whether it stays the same."""

"""`plantar fleet`: many logs of many robots."""

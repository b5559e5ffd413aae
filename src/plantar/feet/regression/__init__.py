"""One axis of one foot as a regression: its fitted model, the columns and data of eq. 6, and what it predicts."""

"""The anchor: the same board as C, written from the same steps, so that speed is a ratio to compiled C."""

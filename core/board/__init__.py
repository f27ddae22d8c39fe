"""The board: blocks wired together, one tick after another, and everything that happens to them."""

"""The numerics of the bench: pure functions over arrays, no input or output, no clock."""

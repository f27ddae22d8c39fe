"""Reference voltages: what the generator plays."""

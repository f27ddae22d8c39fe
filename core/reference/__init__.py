"""Reference voltages, which the generator plays."""

"""Plants: what the voltage does to the shuttle."""

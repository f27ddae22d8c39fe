"""Ways for other programs and libraries to drive a bench: processes, environments of learning, linear systems."""

"""Theory: properties of a system that need no run."""

"""Theory: what can be said of a system before anything is run."""

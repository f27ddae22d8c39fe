"""Figures measured from a board, or from the trace of a run."""

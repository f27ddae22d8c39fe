"""Supervisors: from the verdict of a diagnoser to an act on the loop."""

"""Faults: the changes they make, the effect of their severity, and the part they are seen on."""

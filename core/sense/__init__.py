"""Sensors: they measure the motion of the shuttle for controllers and diagnosers."""

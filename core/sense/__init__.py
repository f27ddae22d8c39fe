"""Sensors: what the controllers are told of the shuttle."""

"""Rotation of the device: generators of angular rate."""

"""Identifiers: what the device is, from voltage and displacement."""

"""Identifiers: parameters of the device, from voltage and displacement."""

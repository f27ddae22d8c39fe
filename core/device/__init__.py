"""Devices: from geometry or measured values to the parameters of an oscillator."""

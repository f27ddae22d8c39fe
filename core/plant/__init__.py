"""Plants: the motion of the shuttle under the voltage."""

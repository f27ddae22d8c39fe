"""The picture of gyroscopes: masses that move along two axes, schematic, because no drawing of them is known."""

"""Instruments that send their samples: their connections, and the records that grow from them."""

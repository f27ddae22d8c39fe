"""The picture of comb resonators, by their drawing."""

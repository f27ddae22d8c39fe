"""How fast the bench is: each figure as a ratio to a peer measured in the same run."""

"""Speed of the bench: each figure is a ratio to a peer measured in the same run."""

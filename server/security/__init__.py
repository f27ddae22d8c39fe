"""Access to the bench: token, origin, headers, limits."""

"""Who may speak to the bench, from where, and how much."""

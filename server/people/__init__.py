"""People: who they are, what each may do, classes and what was done in them."""

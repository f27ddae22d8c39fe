"""People: their identities, their rights, classes and the actions in them."""

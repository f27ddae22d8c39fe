"""Plain sentences about what happens on a bench, made of its samples and its log."""

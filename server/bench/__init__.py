"""Live benches: one board each, all advanced by one engine thread."""

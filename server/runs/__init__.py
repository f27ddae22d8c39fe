"""Headless runs in addition to the live benches, in a process of their own."""

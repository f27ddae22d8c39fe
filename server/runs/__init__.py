"""Headless runs beside the live benches, in a process of their own."""

"""Scenarios, runs and reports. Importing this first gives compiled kernels their cache, and benches their records."""

from scenarios import kernel_cache
from scenarios.records import shelf

kernel_cache.prepare()
shelf.prepare()

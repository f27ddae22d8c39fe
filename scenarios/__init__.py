"""Scenarios, runs and reports. Importing this first gives compiled kernels their cache."""

from scenarios.kernel_cache import prepare

prepare()

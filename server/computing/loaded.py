"""Code of the computations for requests: importing this module loads it."""

from importlib import import_module

for name in ("bench_files", "devices", "diagnosers", "experiments", "records", "scenarios", "theory", "units"):
    import_module(f"server.api.{name}")

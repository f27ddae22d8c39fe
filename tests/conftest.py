"""Settings every test shares."""

from __future__ import annotations

from hypothesis import HealthCheck, settings

import scenarios  # noqa: F401  (first: it gives compiled kernels their cache)

# the same examples every time: what fails once fails again
settings.register_profile(
    "bench",
    derandomize=True,
    deadline=None,
    max_examples=25,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("bench")

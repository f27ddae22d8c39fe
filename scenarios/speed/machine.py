"""The machine that figures are of: its processor, how wide its vectors are, and how busy it is."""

from __future__ import annotations

import os
import platform
import re
from pathlib import Path
from typing import Any

from core.compile.machine import native

VECTORS = {"avx2": "AVX2", "avx512f": "AVX-512", "neon": "NEON"}
BUSY = 1.0
"""Load of the machine above which others take part of its processors and caches."""


def machine() -> dict[str, Any]:
    """Return the processor, its vectors, how many there are, and the load of the last minute, JSON-ready."""
    features = native().features.split(",")
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else None
    return {
        "processor": _processor(),
        "processors": os.cpu_count() or 1,
        "vectors": [name for feature, name in VECTORS.items() if f"+{feature}" in features],
        "load": load,
        "busy": load is not None and load > BUSY,
    }


def _processor() -> str:
    told = Path("/proc/cpuinfo")
    found = re.search(r"^model name\s*:\s*(.+)$", told.read_text(), re.MULTILINE) if told.exists() else None
    return found[1] if found else platform.processor() or platform.machine()

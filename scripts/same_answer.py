"""Whether two recorded answers are the same."""

from __future__ import annotations

import math
from typing import Any


def is_same(one: Any, other: Any) -> bool:
    """Say whether two answers are the same; the last digits of some figures depend on the processor."""
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=1e-9)
    if isinstance(one, dict) and isinstance(other, dict):
        return list(one) == list(other) and all(is_same(value, other[name]) for name, value in one.items())
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(is_same, one, other))
    return type(one) is type(other) and bool(one == other)

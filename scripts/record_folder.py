"""Record a bench in a folder for the tests of the page: its code, its document and the answers beside it."""

from __future__ import annotations

import base64
import math
from typing import Any

import numpy as np

from scenarios.in_a_file.bench_file import bench_file
from scenarios.library import get
from server.cli.folder import answers

LEFT_OUT = ("catalog",)
"""Answers that are recorded elsewhere."""


def folder_bench(scenario: str) -> dict[str, Any]:
    """Return a bench in a folder as plain values, so that figures of two recordings can be compared."""
    made = bench_file(get(scenario))
    found = answers(get(scenario), made)
    return {
        "code": base64.b64encode(made.code).decode(),
        "document": _plain(made.document),
        "answers": {name: one for name, one in found.items() if name not in LEFT_OUT},
    }


def _plain(value: Any) -> Any:
    """Return a document with its arrays as lists; numbers that JSON has not as words."""
    if isinstance(value, np.ndarray):
        return {"array": value.dtype.name, "numbers": [_word(one) for one in value.ravel().tolist()]}
    if isinstance(value, dict):
        return {name: _plain(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    return value.item() if isinstance(value, np.generic) else value


def _word(number: float) -> float | str:
    """Return a number; a large whole one in hexadecimal, one that is not finite by its name in JavaScript."""
    if isinstance(number, int):
        return number if abs(number) < 1 << 53 else f"{number:#x}"
    if math.isfinite(number):
        return number
    return "NaN" if math.isnan(number) else "Infinity" if number > 0.0 else "-Infinity"

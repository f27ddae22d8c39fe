"""Whole numbers near a number."""

from __future__ import annotations

from math import floor

__all__ = ["MAGIC", "floor"]

MAGIC = 6755399441055744.0
r"""1.5 2^52: :math:`(x+M)-M` is the whole number nearest to x, and the last bits of x + M are that number."""

"""What kernels may call that becomes instructions of the processor, as plain Python does it."""

from __future__ import annotations

import ctypes
import struct
from typing import Any

_DOUBLE, _INTEGER = struct.Struct("<d"), struct.Struct("<q")
_STEP = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)


def bits_of(value: float) -> int:
    """Return the 64 bits of a number as a signed integer."""
    bits: int = _INTEGER.unpack(_DOUBLE.pack(value))[0]
    return bits


def number_of(bits: int) -> float:
    """Return the number that has these 64 bits."""
    value: float = _DOUBLE.unpack(_INTEGER.pack(bits))[0]
    return value


def whole(n: int) -> int:
    """Return the size of whole vector registers for ``n`` numbers.

    A loop over vectors with room for more numbers may run this far: no rest is then computed one by one.
    The numbers after the n-th are unused. Boards abreast fill registers with boards and go to ``n`` alone.
    """
    return (n + 7) >> 3 << 3


def address_of(array: Any) -> int:
    """Return where the numbers of an array are in memory."""
    return int(array.ctypes.data)


def call(address: int, p: int, s: int, w: int, io: int) -> None:
    """Call the C function at an address with four pointers given as integers."""
    _STEP(address)(p, s, w, io)

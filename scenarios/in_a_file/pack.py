"""A pack: a document and the arrays it names, as one text that a page reads.

The bytes are the length of the document, the document as JSON, and the arrays, each from a multiple of eight bytes on.
In the document an array is ``{"array": kind, "at": place, "lengths": [...]}``.
"""

from __future__ import annotations

import base64
import gzip
import json
from typing import Any

import numpy as np

ALIGNMENT = 8


def packed(document: dict[str, Any]) -> bytes:
    """Return the bytes of a document with arrays in it."""
    parts: list[bytes] = []
    head = json.dumps(_without_arrays(document, parts), separators=(",", ":"), allow_nan=False).encode()
    first = ALIGNMENT + len(head)
    room = bytes(-first % ALIGNMENT)
    return len(head).to_bytes(ALIGNMENT, "little") + head + room + b"".join(parts)


def text_of(content: bytes) -> str:
    """Return bytes as a text for a page: compressed, in base 64."""
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode()


def _without_arrays(value: Any, parts: list[bytes]) -> Any:
    """Return a document with the places of its arrays, whose bytes are added to the parts."""
    if isinstance(value, np.ndarray):
        data = np.ascontiguousarray(value)
        content = data.astype(data.dtype.newbyteorder("<")).tobytes()
        place = sum(map(len, parts))
        parts.append(content + bytes(-len(content) % ALIGNMENT))
        return {"array": data.dtype.name, "at": place, "lengths": list(data.shape)}
    if isinstance(value, dict):
        return {name: _without_arrays(one, parts) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [_without_arrays(one, parts) for one in value]
    return value.item() if isinstance(value, np.generic) else value

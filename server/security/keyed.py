"""A hash that only the holder of a key can work out."""

from __future__ import annotations

import hashlib
import hmac


def keyed_hash(key: bytes, *words: str) -> bytes:
    """Return HMAC-SHA256 of some words, each with its length before it, so that no two lists of words read alike."""
    message = b"".join(len(word.encode()).to_bytes(4, "big") + word.encode() for word in words)
    return hmac.new(key, message, hashlib.sha256).digest()

"""Draws for each student of a class: the device, the noise, a hidden fault."""

from __future__ import annotations

from server.security.keyed import keyed_hash


def draw(secret: str, *what: str) -> int:
    """Return a number that only the server can know beforehand: the same for the same words, unlike any other.

    Parameters
    ----------
    secret : str
        Of the class; it stays on the server. People alone have none, and all of them draw the same.
    *what : str
        Words for the use of the number: a student, an exercise, a purpose. A different word gives an unrelated number.

    Returns
    -------
    int
        0 to 2**31 - 1, a seed.

    """
    return int.from_bytes(keyed_hash(secret.encode(), *what)[:4], "big") >> 1

"""Draws for a student: HMAC-SHA256 (RFC 2104), so that they cannot be predicted without the secret."""

from __future__ import annotations

import hashlib
import hmac
import itertools

from hypothesis import given
from hypothesis import strategies as st

from server.classroom.draw import draw

WORDS = st.lists(st.text(max_size=5), max_size=4).map(tuple)


def test_it_is_the_head_of_a_keyed_hash_of_the_words() -> None:
    text = b"\x00\x00\x00\x03ada\x00\x00\x00\x06device"
    whole = int.from_bytes(hmac.new(b"secret", text, hashlib.sha256).digest(), "big")
    assert draw("secret", "ada", "device") == whole >> 225


@given(WORDS, WORDS)
def test_other_words_give_another_number(one: tuple[str, ...], other: tuple[str, ...]) -> None:
    assert (draw("secret", *one) == draw("secret", *other)) is (one == other)


def test_every_secret_and_student_draws_alike_from_the_whole_range() -> None:
    drawn = [draw(f"secret {i}", f"student {j}") for i, j in itertools.product(range(100), range(100))]
    assert len(set(drawn)) == 10_000
    mean = sum(drawn) / len(drawn) / 2**31
    assert abs(mean - 0.5) < 4 * (1 / 12 / len(drawn)) ** 0.5  # four deviations of the mean of a uniform draw

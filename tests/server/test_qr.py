"""The QR code of an address, which a phone reads from the screen of the page."""

from __future__ import annotations

import base64
import io
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread
from numpy.typing import NDArray

FINDER = ["#######", "#.....#", "#.###.#", "#.###.#", "#.###.#", "#.....#", "#######"]


def drawn(live: Any, text: str) -> NDArray[np.bool_]:
    """Return the dark modules of a code."""
    image = live.http.post("/api/v1/qr", json={"text": text}).json()["image"]
    assert image.startswith("data:image/png;base64,")
    pixels = imread(io.BytesIO(base64.b64decode(image.partition(",")[2])))
    grey = pixels if pixels.ndim == 2 else pixels[:, :, 0]
    return np.asarray(grey[4::8, 4::8] < 0.5)


def test_a_code_has_its_three_finders_and_four_light_modules_around_it(live: Any) -> None:
    dark = drawn(live, "lab.example")
    assert dark.shape == (21 + 8, 21 + 8)
    finder = np.array([[sign == "#" for sign in row] for row in FINDER])
    for x, y in ((4, 4), (18, 4), (4, 18)):
        assert (dark[y : y + 7, x : x + 7] == finder).all()
    assert not dark[:4].any() and not dark[-4:].any() and not dark[:, :4].any() and not dark[:, -4:].any()


def test_a_longer_address_has_a_larger_code_of_its_own(live: Any) -> None:
    first, second = (drawn(live, f"https://lab.example/bench/?link={word * 60}") for word in "ab")
    assert first.shape == second.shape > (29, 29) and (first != second).any()


@pytest.mark.parametrize("text", ["", "two words", "x" * 1001, "Ω"])
def test_only_an_address_has_a_code(live: Any, text: str) -> None:
    assert live.http.post("/api/v1/qr", json={"text": text}).status_code == 422

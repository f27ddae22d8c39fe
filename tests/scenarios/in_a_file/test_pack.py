"""The pack of a bench in a file: a document with arrays as bytes, read again without the code that wrote it."""

from __future__ import annotations

import base64
import gzip
import json

import numpy as np

from scenarios.in_a_file.pack import packed, text_of


def test_each_array_is_at_its_place_with_its_kind_and_its_lengths():
    numbers, places = np.array([[0.1, np.nan], [np.inf, -0.0]]), np.arange(3)
    content = packed({"a": {"numbers": numbers}, "b": [places, "text"], "c": np.float64(2.5)})
    length = int.from_bytes(content[:8], "little")
    document = json.loads(content[8 : 8 + length])
    first = -(-(8 + length) // 8) * 8
    assert document["c"] == 2.5 and document["b"][1] == "text"
    for entry, array in ((document["a"]["numbers"], numbers), (document["b"][0], places)):
        at = first + entry["at"]
        assert at % 8 == 0 and entry["lengths"] == list(array.shape)
        read = np.frombuffer(content, entry["array"], array.size, at).reshape(entry["lengths"])
        assert read.tobytes() == array.tobytes()


def test_a_text_is_the_same_for_the_same_bytes_and_gives_them_back():
    content = bytes(range(256)) * 9
    assert text_of(content) == text_of(content)
    assert gzip.decompress(base64.b64decode(text_of(content))) == content

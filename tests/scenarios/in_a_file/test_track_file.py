"""A track of the benchmark as a page: its cases are whole, and its rows have the published digests."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scenarios.benchmark.results import kept
from scenarios.benchmark.track import tracks
from scenarios.in_a_file.pack import packed, text_of
from scenarios.in_a_file.track_file import NUMBERS, CaseNumbers, differences, track_file
from tests.scenarios.in_a_file.players import MOST_SECONDS, bundle, node


def _written(base: CaseNumbers, found: dict[str, Any], number: int) -> dict[str, Any]:
    """Return the arrays of a case, from the arrays of the first and the numbers that differ."""
    arrays = {name: base.arrays[name].copy() for name in NUMBERS}
    for name in NUMBERS:
        part = found["differs"][name]
        arrays[name][part["places"]] = found["numbers"][part["which"], number]
    return arrays


def test_every_number_of_a_case_comes_back_and_a_shared_number_is_kept_once():
    rng = np.random.default_rng(1)
    shared, own = rng.normal(size=(2, 5))
    cases = [
        CaseNumbers(
            b"", {"p": np.array([7.0, shared[k], own[k], shared[k]]), "s": np.array([shared[k]]), "w": np.zeros(3)}, {}
        )
        for k in range(5)
    ]
    found = differences(cases)
    assert found["numbers"].shape == (2, 5)
    assert found["differs"]["p"]["places"].tolist() == [1, 2, 3] and not found["differs"]["w"]["places"].size
    for number, case in enumerate(cases):
        written = _written(cases[0], found, number)
        assert all(np.array_equal(written[name], case.arrays[name]) for name in NUMBERS)


@pytest.mark.long
@pytest.mark.parametrize("name", tracks())
def test_the_cases_of_a_track_give_the_published_digest_of_each_row(name: str):
    file = track_file(name)
    given = json.dumps({"code": text_of(file.code), "pack": text_of(packed(file.document))})
    script = str(Path(__file__).with_name("track.mjs"))
    ended = subprocess.run(
        [node(), script, bundle()], input=given, capture_output=True, text=True, check=False, timeout=MOST_SECONDS
    )
    assert ended.returncode == 0, ended.stderr
    expected = {row.unit: row.digest for row in kept().rows if row.track == name}
    assert len(expected) > 10 and json.loads(ended.stdout) == expected

"""Scenarios from Python: each way to name one, and refusals before anything runs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import combbench as cb
from core.board.document import written_over
from scenarios.library import get

TEXT = get("first-look").toml()


def test_an_id_a_path_a_text_and_a_document_are_the_same_scenario(tmp_path: Path) -> None:
    path = tmp_path / "bench.toml"
    path.write_text(TEXT, "utf-8-sig")
    sources: list[str | Path | dict[str, Any]] = ["first-look", path, str(path), TEXT, get("first-look").document]
    specs = [cb.Scenario.load(source).spec for source in sources]
    assert all(spec == get("first-look").spec for spec in specs)


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"events": [{"at_ms": 1, "fault": "added_mas", "severity": 0.1}]}, "events.0.fault"),
    ({"events": [{"at_ms": 1, "switch": "mracc"}]}, "events.0"),
    ({"events": [{"at_ms": 1, "set": {"sensor.nothing": 1}}]}, "events.0"),
    ({"events": [{"when": "plant.displacment > 1", "switch": "pid"}]}, "events.0.when"),
    ({"reference.amplitude_v": "10"}, "reference.amplitude_v"),
    ({"device.id": "ch33"}, "device.id"),
    ({"nothing": 1}, "nothing"),
]


@pytest.mark.parametrize(("values", "words"), WRONG, ids=[words for _, words in WRONG])
def test_loading_refuses_everything_that_a_run_refuses_in_the_same_words(values: dict[str, Any], words: str) -> None:
    document = written_over(get("first-look").document, values)
    with pytest.raises(cb.InputError) as loaded:
        cb.Scenario.load(document)
    with pytest.raises(cb.InputError) as ran:
        cb.run(document)
    assert str(loaded.value) == str(ran.value)
    assert words in str(loaded.value)


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("nope", "unknown scenario 'nope'"),
        ("nope.toml", "cannot read nope.toml"),
        ("a = = 1", "line 1"),
        (Path("nowhere"), "cannot read nowhere"),
    ],
)
def test_a_source_that_is_no_scenario_is_refused_in_one_line(source: str | Path, words: str) -> None:
    with pytest.raises(cb.InputError, match=words) as refused:
        cb.run(source)
    assert "\n" not in str(refused.value)


def test_values_are_set_by_dotted_paths(tmp_path: Path) -> None:
    ran = cb.run("first-look", set={"samples": 50, "seed": 4})
    assert (len(ran.time), ran.seed) == (50, 4)
    with pytest.raises(cb.InputError, match="samples"):
        cb.run("first-look", set={"samples": -1})

"""Seeds of the benchmark: anyone works out the public seeds, and a change of the hidden seeds is visible."""

from __future__ import annotations

import hashlib
import re

import pytest
import tomlkit

from core.errors import InputError
from scenarios.benchmark import seeds
from scenarios.benchmark.track import tracks

NAMES = tuple(tracks())


def test_public_seeds_follow_from_the_name_alone() -> None:
    """128 bits of SHA-256 over benchmark, list, track and number, as the document says."""
    first = seeds.seed_list("public", NAMES).cases["known"][0]
    assert first == hashlib.sha256(b"mems-diag-1 public cases known 1").hexdigest()[:32]


def test_no_two_seeds_are_the_same() -> None:
    """Neither within a list nor between lists, tracks and the healthy runs."""
    lists = [seeds.seed_list(name, NAMES) for name in seeds.LISTS]
    found = [seed for one in lists for track in NAMES for seed in one.cases[track]]
    found += [seed for track in NAMES for seed in lists[0].calibration(track)]
    assert len(found) == len(set(found))
    assert all(re.fullmatch("[0-9a-f]{32}", seed) for seed in found)


def test_a_hidden_list_is_read_if_it_is_the_committed_one(monkeypatch: pytest.MonkeyPatch) -> None:
    hidden = seeds.hidden_of("5a" * 32, NAMES)
    text = tomlkit.dumps(hidden.model_dump())
    with pytest.raises(InputError, match="not the list that was committed"):
        seeds.hidden_list(text, NAMES)
    monkeypatch.setattr(seeds, "COMMITMENT", hidden.commitment())
    read = seeds.hidden_list(text, NAMES)
    assert read.cases["known"] == tuple(hidden.cases["known"]) and read.name == "hidden"


def test_the_commitment_is_the_hash_that_the_document_gives() -> None:
    """SHA-256 over the salt and, track by track in the order of names, the name, a line end and the seeds."""
    hidden = seeds.SecretSeeds(salt="ab" * 32, cases={"b": ["01" * 16, "02" * 16], "a": ["03" * 16]})
    said = bytes.fromhex("ab" * 32) + b"a\n" + b"\x03" * 16 + b"b\n" + b"\x01" * 16 + b"\x02" * 16
    assert hidden.commitment() == hashlib.sha256(said).hexdigest()


@pytest.mark.parametrize("change", ["salt", "seed", "order"])
def test_any_change_of_a_hidden_list_shows(change: str, monkeypatch: pytest.MonkeyPatch) -> None:
    hidden = seeds.hidden_of("5a" * 32, NAMES)
    monkeypatch.setattr(seeds, "COMMITMENT", hidden.commitment())
    document = hidden.model_dump()
    listed = document["cases"]["drift"]
    if change == "salt":
        document["salt"] = "0" * 64
    elif change == "seed":
        listed[3] = "0" * 32
    else:
        listed[0], listed[1] = listed[1], listed[0]
    with pytest.raises(InputError, match="not the list"):
        seeds.hidden_list(tomlkit.dumps(document), NAMES)


@pytest.mark.parametrize(
    ("text", "field"),
    [("salt =", "--seeds"), ("salt = 'ab'\n[cases]", "--seeds.salt"), (f"salt = '{'0' * 64}'\n[cases]", "--seeds")],
)
def test_a_malformed_list_is_refused_by_name(text: str, field: str) -> None:
    with pytest.raises(InputError) as refused:
        seeds.hidden_list(text, NAMES)
    assert refused.value.field == field


def test_a_new_hidden_list_is_printed_with_its_commitment(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["seeds"])
    seeds.main()
    printed = capsys.readouterr()
    monkeypatch.setattr(seeds, "COMMITMENT", printed.err.split()[-1])
    assert seeds.hidden_list(printed.out, NAMES).cases.keys() == set(NAMES)


def test_the_repository_commits_to_one_list() -> None:
    assert re.fullmatch("[0-9a-f]{64}", seeds.COMMITMENT)

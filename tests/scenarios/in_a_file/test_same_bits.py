"""Random scripts of commands: the digest, the ticks and the log of a bench in a file are those of a native board."""

from __future__ import annotations

import pytest

from core.errors import InputError
from scenarios.in_a_file.bench_file import bench_file, refusal
from scenarios.library import get, library
from tests.scenarios.in_a_file.scripts import Bout, bits_alike, in_files, kinds_of

MANY = (
    "first-look",
    "ch1-hardening",
    "ch1-short-circuit",
    "ch3-ageing-four-weeks",
    "ch3-case2-broken-truss",
    "ch3-debris",
    "ch3-pull-in-map",
    "ch5-drift",
    "ch5-seven-step",
    "ch6-mimo",
    "ch6-sense-axis-sync",
    "gyro-diagnosis",
    "gyro-first-look",
    "gyro-whole-angle",
)
TICKS, COMMANDS = 3000, 14


def _compare(name: str, count: int) -> None:
    bout = Bout.of(get(name))
    scripts, natives = zip(*(bout.script(seed, TICKS, COMMANDS) for seed in range(count)), strict=True)
    assert sum(len(script["commands"]) for script in scripts) > 3 * count
    (played,) = in_files([bout], [list(scripts)])
    for script, native, found in zip(scripts, natives, played, strict=True):
        assert found["refused"] == [], script
        assert (found["digest"], found["tick"]) == (native["digest"], native["tick"]), script
        assert bits_alike([*map(int, found["bits"])]) == native["bits"], script
        assert kinds_of(found["log"]) == native["kinds"], script


@pytest.mark.parametrize("name", ["gyro-waveform"])
def test_random_commands_give_the_bits_of_a_native_board(name: str):
    _compare(name, 4)


@pytest.mark.long
@pytest.mark.parametrize("name", MANY)
def test_many_random_commands_give_the_bits_of_a_native_board(name: str):
    _compare(name, 18)


def test_what_no_file_can_be_is_refused_with_its_reason():
    reasons = {scenario.id: refusal(scenario) for scenario in library()}
    assert sum(not reason for reason in reasons.values()) > 75
    assert "twins" in reasons["ch3-baselines"] and "study" in reasons["appB-mit"]
    with pytest.raises(InputError, match="ch3-baselines cannot be a bench in a file: it has twins"):
        bench_file(get("ch3-baselines"))

"""Random scripts of commands: the digest, the ticks and the log of a bench in a file are those of a native board."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from core.board.board import Board
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.in_a_file.bench_file import bench_file, refusal
from scenarios.library import get, ids, library
from scenarios.run import DEFAULT_SAMPLES, run
from tests.scenarios.in_a_file.players import Player, in_chromium, in_firefox, in_node
from tests.scenarios.in_a_file.scripts import SLICES, Bout, Scripts, bits_alike, jobs_of, kinds_of

MANY = (
    "first-look",
    "ch1-hardening",
    "ch1-shock",
    "ch1-short-circuit",
    "ch2-beams",
    "ch2-sensor-dropout",
    "ch3-ageing-four-weeks",
    "ch3-baselines",
    "ch3-case2-broken-truss",
    "ch3-debris",
    "ch3-mrac-noise",
    "ch3-optical-loop",
    "ch3-pull-in-map",
    "ch3-robust",
    "ch3-stvsc-pull-in",
    "ch4-augmentation",
    "ch4-double-integrator",
    "ch4-lcr-two-tone",
    "ch5-consistency",
    "ch5-drift",
    "ch5-late-drive",
    "ch5-redesign",
    "ch5-seven-step",
    "ch5-short-circuit",
    "ch6-mimo",
    "ch6-sense-axis-sync",
    "gyro-comb-device",
    "gyro-diagnosis",
    "gyro-first-look",
    "gyro-whole-angle",
)
TICKS, COMMANDS, SCRIPTS = 3000, 14, 34
LIGHT = "gyro-waveform"


@cache
def _played(name: str, count: int) -> tuple[Bout, Scripts]:
    """Return scripts of a scenario, played on native boards."""
    bout = Bout.of(get(name))
    return bout, [bout.script(seed, TICKS, COMMANDS) for seed in range(count)]


def _compare(player: Player, bout: Bout, scripts: Scripts) -> None:
    assert sum(len(script["commands"]) for script, _ in scripts) > 3 * len(scripts)
    (played,) = player(jobs_of([bout], [[script for script, _ in scripts]]))
    for (script, native), found in zip(scripts, played, strict=True):
        assert found["refused"] == [], script
        assert (found["digest"], found["tick"]) == (native["digest"], native["tick"]), script
        assert bits_alike([*map(int, found["bits"])]) == native["bits"], script
        assert kinds_of(found["log"]) == native["kinds"], script


@pytest.mark.parametrize("name", [LIGHT, "gyro-not-exciting"])
def test_random_commands_give_the_bits_of_a_native_board(name: str):
    _compare(in_node, *_played(name, 3))


@pytest.mark.long
@pytest.mark.parametrize("name", MANY)
@pytest.mark.parametrize("player", [in_node, in_chromium, in_firefox])
def test_many_random_commands_give_the_bits_of_a_native_board(name: str, player: Player):
    _compare(player, *_played(name, SCRIPTS))


@pytest.mark.long
@pytest.mark.parametrize("name", ids())
def test_a_scenario_of_the_library_gives_its_published_digest(name: str):
    scenario = get(name)
    if refusal(scenario):
        return  # counted below
    bout = Bout.of(scenario)
    script = {"ticks": scenario.samples or DEFAULT_SAMPLES, "slices": [4096], "commands": []}
    ((found,),) = in_node(jobs_of([bout], [[script]]))
    native = run(scenario, figures_only=True)
    assert (found["digest"], found["tick"]) == (native.digest, native.board.tick)


def test_one_packed_number_changed_gives_another_digest():
    bout = Bout.of(get(LIGHT))
    script = {"ticks": 200, "slices": SLICES, "commands": []}
    running = bout.file.document["running"]
    first, end = bout.file.document["rows"][running[0]]["p"]
    numbers = bout.file.document["arrays"]["p"].copy()
    place = first + int(np.flatnonzero(numbers[first:end])[0])
    numbers[place] = np.nextafter(numbers[place], np.inf)
    arrays = {**bout.file.document["arrays"], "p": numbers}
    other = replace(bout, file=replace(bout.file, document={**bout.file.document, "arrays": arrays}))
    (plain,), (changed,) = in_node(jobs_of([bout, other], [[script], [script]]))
    assert plain["digest"] == run(with_values(get(LIGHT), {"samples": 200})).digest != changed["digest"]


@pytest.mark.long
def test_a_twin_that_rests_has_no_numbers_and_the_past_of_all_boards_is_the_native_past():
    bout = Bout.of(with_values(get("ch3-stvsc-pull-in"), {"diagnosers": {}}))
    board = Board.restore(bout.start)
    rows = []
    while board.tick < 400 and (ran := board.advance(200)).count:
        rows.append(np.hstack([ran.outputs, ran.taps]))
    native = np.vstack(rows).astype(np.float32)
    assert np.isnan(native[-1]).any() and not np.isnan(native[-1, 0])
    columns = [k for k, signal in enumerate(board.signals) if signal.name.endswith(("displacement", "drive.voltage"))]
    seen = {"signals": columns, "ticks": 300}
    script = {"ticks": board.tick, "slices": SLICES, "commands": [], "seen": seen}
    ((found,),) = in_node(jobs_of([bout], [[script]]))
    traces = np.array(found["trace"], dtype=np.uint32).view(np.float32).reshape(len(columns), 2, 300)
    np.testing.assert_array_equal(traces[:, 0], native[-300:, columns].T)
    np.testing.assert_array_equal(traces[:, 1], native[-300:, columns].T)


def test_slow_blocks_and_conditions_of_events_are_in_a_file():
    values = {
        "diagnosers.kalman.every": 4,
        "events": [
            {"when": "plant.displacement > 0.2", "fault": "added_mass", "severity": 0.0371},
            {"at_sample": 900, "when": "plant.displacement < -0.2", "heal": "all"},
        ],
    }
    bout = Bout.of(with_values(get("ch5-seven-step"), values))
    script, native = bout.script(0, 1500, 0)
    assert [kind for _, kind in native["kinds"] if kind in ("inject", "heal")] == ["inject", "heal"]
    ((found,),) = in_node(jobs_of([bout], [[script]]))
    assert (found["digest"], kinds_of(found["log"])) == (native["digest"], native["kinds"])


@pytest.mark.long
def test_a_supervisor_with_a_table_acts_at_the_same_ticks():
    bout = Bout.of(with_values(get("ch5-redesign"), {"samples": 3000}))
    board = Board.restore(bout.start)
    while board.tick < 3000:
        board.advance(500)
    acted = [one.tick for twin in board.twins.values() for one in twin.consequences]  # type: ignore[attr-defined]
    assert acted
    script = {"ticks": 3000, "slices": SLICES, "commands": []}
    ((found,),) = in_node(jobs_of([bout], [[script]]))
    assert found["digest"] == board.digest()


def test_what_no_file_can_be_is_refused_with_its_reason():
    reasons = {scenario.id: refusal(scenario) for scenario in library()}
    assert sum(not reason for reason in reasons.values()) > 110
    assert "supervisor" in reasons["ch5-fault-tolerant"] and "study" in reasons["appB-mit"]
    with pytest.raises(InputError, match="appB-mit cannot be a bench in a file: it is a study"):
        bench_file(get("appB-mit"))

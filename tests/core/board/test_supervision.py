"""A supervised run: the same acts and the same bits, however it is computed, and no act is a command."""

from __future__ import annotations

import copy
from typing import Any

import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from core.board.board import Board
from core.board.ensemble import make as make_ensemble
from core.board.stored import revived, stored
from core.board.supervision import check
from core.board.track import Deed, Track
from core.errors import InputError
from core.wall import wall
from scenarios.campaign.batch import outcomes, shape
from scenarios.run import run
from scenarios.schema import Scenario
from tests.lab import RICH, do, document, inner_digest, make, play, run_digest

TICKS = 1000
SOON = {"hold_ms": 0.4, "dead_ms": 0.4}
KINDS: dict[str, dict[str, Any]] = {
    "switching": {"kind": "switching", "nominal": "open_loop", "controllers": {"m+5": "lqg", "b+30": "pid"}, **SOON},
    "scheduling": {
        "kind": "scheduling",
        **SOON,
        "schedule": [
            {"name": "healthy", "set": {"controllers.lqg.voltage_cost_um_v": 0.03, "controllers.lqg.mass_ratio": 1.0}},
            {"name": "m+5", "set": {"controllers.lqg.mass_ratio": 1.05}},
        ],
    },
    "retuning": {"kind": "retuning", **SOON},
    "shutdown": {"kind": "shutdown", **SOON},
}
STORY = [
    {"fault": "added_mass", "severity": 0.05, "at_sample": 300},
    {"set": {"reference.amplitude_v": 7.0}, "at_sample": 200, "when": "kalman.winner > 0.5"},
    {"heal": "all", "at_sample": 650},
]


def bench(kind: str = "switching", **more: Any) -> dict[str, Any]:
    base = copy.deepcopy(RICH) | {"sample_rate_khz": 50, "controller": {"kind": "lqg"}}
    base["diagnosers"] = {"kalman": base["diagnosers"]["kalman"]}
    return document({"supervisor": {**KINDS[kind], **more}}, base)


def supervised(kind: str = "switching", commands: list[dict[str, Any]] = STORY, **rest: Any) -> Board:
    return make({}, commands, base=bench(kind), **rest)


def acts(board: Board) -> list[tuple[int, str]]:
    return [(entry.tick, entry.text) for entry in board.log if entry.actor == "supervisor"]


def same(first: Board, second: Board) -> None:
    assert first.digest() == second.digest() and inner_digest(first) == inner_digest(second)
    assert first.consequences == second.consequences and first.spec.document == second.spec.document


@pytest.mark.parametrize("kind", KINDS)
def test_a_run_its_scenario_and_plain_python_are_one_run(kind: str) -> None:
    board = supervised(kind)
    play(board, TICKS)
    assert board.consequences and len(acts(board)) == len(board.consequences)
    told = {str(command) for _, command in board.done}
    assert not told & {str(command) for _, command, _ in board.consequences}
    saved = board.save()
    again = make({}, saved["events"], base={key: saved[key] for key in saved if key not in ("events", "samples")})
    play(again, TICKS)
    same(again, board)
    assert acts(again) == acts(board)
    slow = supervised(kind, compiled=False)
    play(slow, 500)
    assert slow.digest() == run_digest(supervised(kind), 500)


@settings(max_examples=8, deadline=None, phases=[Phase.generate])
@given(
    kind=st.sampled_from(sorted(KINDS)),
    chunks=st.lists(st.integers(1, 65), min_size=4, max_size=12),
    away=st.integers(1, 200),
)
def test_copies_at_any_tick_continue_as_the_run(kind: str, chunks: list[int], away: int) -> None:
    straight, board = supervised(kind), supervised(kind)
    track = Track(board, 8_000_000)
    play(straight, TICKS)
    for n in chunks:
        board.advance(n)
        track.follow(board)
    kept, data = board.checkpoint(), stored(board)
    play(board, away)
    play(board, TICKS - board.tick)
    same(board, straight)
    for other in (Board.restore(kept), Board.restore(kept), revived(data), track.to(kept.tick).board()):
        play(other, TICKS - other.tick)
        same(other, straight)


def test_the_tick_of_a_request_is_no_place_where_an_act_is_lost_or_done_twice() -> None:
    straight = supervised()
    play(straight, TICKS)
    edge = straight.consequences[0][0]
    board = supervised()
    play(board, edge)
    assert board.value("supervisor.request") > 0.0 and not board.consequences
    kept = board.checkpoint()
    board.apply_due()
    assert [tick for tick, *_ in board.consequences] == [edge] and board.value("supervisor.request") == 0.0
    after, data = board.checkpoint(), stored(board)
    for other in (board, Board.restore(kept), Board.restore(after), revived(data)):
        play(other, TICKS - other.tick)
        same(other, straight)


def test_a_command_at_the_tick_of_an_act_comes_after_it_live_and_replayed() -> None:
    edge = _first_edge()
    live = supervised()
    play(live, edge)
    track = Track(live, 8_000_000)
    do(live, {"switch": "pid"})
    track.note(Deed(edge, live.done[-1][1], "test"))
    assert live.spec.active == "pid" and live.consequences[0][0] == edge
    play(live, TICKS - edge)
    saved = live.save()
    headless = make({}, saved["events"], base={key: saved[key] for key in saved if key not in ("events", "samples")})
    play(headless, TICKS)
    same(headless, live)
    same(track.to(TICKS).board(), live)


def _first_edge() -> int:
    board = supervised()
    play(board, TICKS)
    return board.consequences[0][0]


def test_a_healthy_start_misleads_a_condition_and_no_supervisor() -> None:
    fooled = supervised(commands=[{"switch": "pid", "when": "kalman.winner > 0.5"}])
    play(fooled, 200)
    assert fooled.done and fooled.done[0][0] < 10
    for kind in KINDS:
        board = supervised(kind, commands=[])
        trace = play(board, TICKS)
        # the table of the switching supervisor begins with another controller than the bench
        assert len(board.consequences) == (kind == "switching"), kind
        assert not (trace["supervisor.request"] > 1.0).any(), kind


def test_the_log_says_why() -> None:
    board = supervised("retuning")
    play(board, 600)
    assert acts(board)[0][1].startswith("set controllers.lqg.mass_ratio = 1.04")
    assert "the estimate of kalman has moved by" in acts(board)[0][1]
    board = supervised()
    play(board, 600)
    assert "kalman has named m+5 for 400\u00a0µs, weight 0.998" in acts(board)[-1][1]


@pytest.mark.parametrize(("way", "kinds"), [("hold", []), ("nominal", ["switch"]), ("safe", ["make_safe"])])
def test_a_fault_that_no_hypothesis_describes(way: str, kinds: list[str]) -> None:
    base = bench(on_unknown=way, nominal="lqg", controllers={"m+5": "lqg", "b+30": "lqg"}) | {
        "controller": {"kind": "pid"}
    }
    base["supervisor"]["threshold"] = 1.0  # no weight is a verdict
    board = make({}, [{"fault": "stiffness", "severity": 0.4, "at_sample": 300}], base=base)
    play(board, 900)
    assert [command.kind for _, command, _ in board.consequences] == kinds
    assert (board.trip is not None) == (way == "safe")


def test_a_twin_has_a_supervisor_of_its_own() -> None:
    base = bench()
    supervisor = base.pop("supervisor")
    board = make_ensemble({**base, "twins": {"supervised": {"supervisor": supervisor}}})
    alone = make({}, STORY[:1], base={**base, "supervisor": supervisor})
    do(board, STORY[0])
    trace = play(board, 800)
    play(alone, 800)
    assert board.twins["supervised"].digest() == alone.digest() and not board.consequences
    assert "supervised:supervisor.request" in trace and "supervisor.request" not in trace


def test_runs_of_a_campaign_are_the_runs_alone() -> None:
    scenario = Scenario.load({**bench(), "samples": 800, "events": [STORY[0]]})
    assert shape(scenario) is None
    found = outcomes([(scenario, seed) for seed in range(1, 5)])
    assert [one.digest for one in found] == [run(scenario, seed).digest for seed in range(1, 5)]


UNIT = '''
from core.ports import tap
from core.record import Record
from core.supervise.supervisor import Supervisor, SupervisorPorts


class Mine(Supervisor):
    """Requests the act of the winner after forty samples of it."""

    title = "Mine"

    class State(Record):
        """The winner, how long, and the act done."""

        winner: float
        held: float
        acted: float

    class Ports(SupervisorPorts):
        """With the time held."""

        held: float = tap("1", "samples")

    @staticmethod
    def step(p: Record, s: State, x: Ports) -> None:
        """Count."""
        s.held = s.held + 1.0 if x.winner == s.winner else 0.0
        s.winner = x.winner
        x.request = 0.0
        if s.held > 40.0 and s.winner != s.acted:
            s.acted = s.winner
            x.request = s.winner + 1.0
        x.held = s.held
'''


@pytest.mark.parametrize("walled", [False, True])
def test_a_unit_supervises_in_machine_code_and_behind_the_wall(walled: bool) -> None:
    table = {"kind": "mine", "acts": [{"switch": "open_loop"}, {"switch": "pid"}, {"switch": "mrac"}]}
    base = {**bench(), "supervisor": table, "units": {"mine": {"source": UNIT}}}
    native = make({}, STORY[:1], base=base)
    play(native, 600)
    assert [command.switch for _, command, _ in native.consequences] == ["pid"]
    wall.demand(walled)
    try:
        other = make({}, STORY[:1], base=base)
        assert run_digest(other, 600) == native.digest()
    finally:
        wall.demand(False)


@pytest.mark.parametrize(
    ("values", "field", "words"),
    [
        ({"supervisor.diagnoser": "kalmann"}, "supervisor.diagnoser", "kalman"),
        ({"supervisor.controllers": {"m+6": "pid"}}, "supervisor.controllers", "m+5"),
        ({"supervisor.nominal": "pdi"}, "supervisor.switch", "pid"),
        ({"supervisor.every": 2}, "supervisor.every", "each tick"),
        ({"supervisor": {"kind": "scheduling", "schedule": [{"name": "m+5", "set": {"a.b": 1}}]}}, "", "healthy"),
        (
            {"supervisor": {"kind": "scheduling", "schedule": [{"name": "healthy", "set": {"supervisor.hold_ms": 1}}]}},
            "",
            "own",
        ),
        ({"supervisor": 3}, "supervisor", "table"),
        ({"supervisor": {"kind": "nothing"}}, "supervisor.kind", "supervisor"),
    ],
)
def test_a_supervisor_that_could_never_act_is_refused(values: dict[str, Any], field: str, words: str) -> None:
    with pytest.raises(InputError) as refused:
        Scenario.load(document(values, bench()))
    assert refused.value.field.startswith(field or "supervisor")
    assert words in f"{refused.value} {refused.value.hint}"


def test_its_parameters_change_while_it_runs_and_its_kind_does_not() -> None:
    board = supervised(commands=[])
    do(board, {"set": {"supervisor.hold_ms": 3.0}})
    assert board.spec.supervisors["supervisor"].params.hold_ms == 3.0
    for values in ({"supervisor.kind": "shutdown"}, {"supervisor.diagnoser": "slow"}):
        with pytest.raises(InputError):
            do(board, {"set": values})
    check(board.spec)

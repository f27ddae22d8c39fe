"""Fast forward and the quiet lead: where they end, who ends them, and that no bit depends on them."""

from __future__ import annotations

from typing import Any

import pytest

from core.errors import InputError
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.bench.commands import parse
from server.bench.time import SHORTLY_S
from server.bench.travel import reset
from server.metrics import Metrics

SCALE = 0.002
SHORTLY = round(SHORTLY_S * SCALE * 50e3)
"""Ticks that are left before an event of the seven steps."""
WATCHED = "plant.displacement > 2.0"


class Clock:
    """Wall time that passes on command."""

    now = 0.0

    def __call__(self) -> float:
        return self.now


def session(lead: bool, scale: float | None = SCALE, **values: Any) -> tuple[LiveBench, Clock]:
    scenario, clock = with_values(get("ch5-seven-step"), values), Clock()
    made = LiveBench(scenario, build(scenario), scale, 20_000, Metrics(), clock)
    made.time.fast_forward.leads = lead
    made.begin(True)
    return made, clock


def go(bench: LiveBench, clock: Clock, wall_s: float) -> None:
    """Pass wall time in rounds, as the engine does; a fast-forwarding bench gets the time of a round."""
    for _ in range(round(wall_s * 120)):
        clock.now += 1 / 120
        if bench.is_running:
            target = bench.time.target(clock.now)
            while bench.time.slice(target):
                pass
            bench.time.finish_round(target, clock.now)


def test_the_lead_is_fast_to_shortly_before_the_first_fault_and_the_pace_is_as_set_after() -> None:
    bench, clock = session(lead=True)
    assert bench.status.fast_forward == "quiet_lead" and bench.status.time_scale == SCALE
    assert bench.time.target(clock.now) == 2000 - SHORTLY  # due at once, whatever the clock says
    go(bench, clock, 2 / 120)
    assert bench.time.fast_forward.reason is None
    begun = bench.board.tick
    assert 2000 - SHORTLY <= begun <= 2000 - SHORTLY + 2
    go(bench, clock, 1.0)
    assert bench.board.tick - begun == pytest.approx(100, abs=2)
    assert not bench.board.faults
    go(bench, clock, SHORTLY_S)
    assert "added_mass" in bench.board.faults and clock.now < 3.1
    assert bench.time.pacer.overruns == 0 and bench.time.pacer.given_up_s == 0.0


def test_the_bits_are_those_of_a_bench_without_it() -> None:
    benches = [session(lead=True), session(lead=False, scale=None)]
    for bench, clock in benches:
        if bench.time.pacer.scale is not None:
            go(bench, clock, 0.5)
            for _ in range(6):
                bench.execute(parse({"kind": "fast_forward"}), "test")
                go(bench, clock, 0.1)
            bench.execute(parse({"kind": "fast_forward"}), "test")
        while bench.is_running:
            go(bench, clock, 0.5)
        assert bench.board.tick == 9000
    (ours, _), (plain, _) = benches
    assert ours.board.digest() == plain.board.digest()
    assert ours.board.save() == plain.board.save()


def test_nothing_leads_unless_asked_to_nor_where_the_first_moment_is_not_known() -> None:
    plain, clock = session(lead=False)
    assert plain.time.fast_forward.reason is None and plain.time.target(clock.now + 1 / 120) in (0, 1)
    waiting, _ = session(lead=True, events=[{"when": WATCHED, "fault": "added_mass", "severity": 0.05}])
    assert waiting.time.fast_forward.reason is None
    quiet, _ = session(lead=True, events=[])
    assert quiet.time.fast_forward.reason is None
    later = {"at_sample": 5000, "heal": "all"}
    soon, _ = session(lead=True, events=[{"at_sample": SHORTLY, "fault": "added_mass", "severity": 0.05}, later])
    assert soon.time.fast_forward.reason is None


@pytest.mark.parametrize(
    "command", [{"kind": "time_scale", "value": SCALE}, {"kind": "time_scale", "value": 0.01}, {"heal": "all"}]
)
def test_who_sets_the_pace_or_does_something_ends_it(command: dict[str, Any]) -> None:
    bench, clock = session(lead=True)
    bench.execute(parse(command), "test")
    assert bench.status.fast_forward is None
    go(bench, clock, 0.1)
    assert bench.board.tick <= 60


def test_a_reset_leads_again_or_runs_to_the_step_that_is_asked_for() -> None:
    bench, clock = session(lead=True)
    go(bench, clock, 0.1)
    again = with_values(get("ch5-seven-step"), {})
    reset(bench, again, build(again), "test")
    assert bench.time.fast_forward.reason == "quiet_lead"
    bench.execute(parse({"kind": "pause"}), "test")
    reset(bench, again, build(again), "test", 4000)
    assert bench.is_running
    go(bench, clock, 2 / 120)
    assert 4000 - SHORTLY <= bench.board.tick <= 4000 - SHORTLY + 2
    assert bench.board.faults["added_mass"].severity == 0.10


def test_skips_go_from_event_to_event_and_then_to_the_end() -> None:
    bench, clock = session(lead=True)
    seen = []
    go(bench, clock, 2 / 120)
    for _ in range(5):
        bench.execute(parse({"kind": "fast_forward"}), "test")
        go(bench, clock, 2 / 120)
        seen.append(bench.board.tick)
    assert seen == pytest.approx([at - SHORTLY for at in (3000, 4000, 5000, 6000, 7000)], abs=3)
    bench.execute(parse({"kind": "fast_forward"}), "test")  # the last event is near: to the end, but to see it
    go(bench, clock, 2 / 120)
    assert bench.board.tick == pytest.approx(9000 - SHORTLY, abs=3) and bench.is_running


def test_a_condition_is_run_to_and_hardly_beyond() -> None:
    mass = {"when": "reference.voltage > 9.9", "at_sample": 500, "fault": "added_mass", "severity": 0.05}
    bench, clock = session(lead=False, events=[mass])
    bench.execute(parse({"kind": "fast_forward"}), "test")
    while bench.time.fast_forward.reason:
        go(bench, clock, 1 / 120)
    fault = bench.board.faults["added_mass"]
    assert fault.start_tick >= 500 and bench.board.tick - fault.start_tick < 10


def test_refusals_change_nothing() -> None:
    bench, clock = session(lead=False)
    go(bench, clock, 0.1)
    last = bench.events.last
    with pytest.raises(InputError, match="tick 1 has passed"):
        bench.execute(parse({"kind": "fast_forward", "before_tick": 1}), "test")
    endless = Scenario.load({k: v for k, v in get("ch5-seven-step").document.items() if k not in ("samples", "events")})
    free = LiveBench(endless, build(endless), SCALE, 20_000, Metrics(), clock)
    with pytest.raises(InputError, match="nothing waits"):
        free.execute(parse({"kind": "fast_forward"}), "test")
    assert bench.events.last == last and bench.time.fast_forward.reason is None

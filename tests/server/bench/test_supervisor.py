"""A supervisor on a live bench: its acts are in the log and the status, and no undo and no way back repeats them."""

from __future__ import annotations

from typing import Any

import pytest

from core.board.library import PLAIN
from core.board.live import value_at
from core.errors import InputError
from core.format import format_short
from scenarios.narrator.words import act_words
from scenarios.run import build, run
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.bench.commands import parse
from server.bench.description import document_of
from server.metrics import Metrics
from tests.core.board.test_supervision import bench as bench_document
from tests.server.bench.test_session import advance

TICKS = 2000
FAULT = {"fault": "added_mass", "severity": 0.05}


def supervised(kind: str = "switching", **more: Any) -> LiveBench:
    own = {"nominal": "lqg", **more} if kind == "switching" else more
    scenario = Scenario.load(bench_document(kind, **own))
    bench = LiveBench(scenario, build(scenario), None, 20_000, Metrics(), lambda: 0.0)
    bench.begin(True)
    return bench


def do(bench: LiveBench, document: dict[str, Any]) -> Any:
    return bench.execute(parse(document), "test")


def sentences(bench: LiveBench) -> list[str]:
    return [sentence.text for sentence in bench.narration.told().sentences]


def acts(bench: LiveBench) -> list[Any]:
    return [event for event in bench.events.after(0)[1] if event.actor == "supervisor"]


def test_the_log_and_the_status_say_what_it_did_and_why() -> None:
    bench = supervised(controllers={"m+5": "pid"})
    advance(bench, 500)
    bench.refresh_status()
    healthy = bench.status.supervisor
    assert healthy is not None and (healthy.verdict, healthy.acts, healthy.last_act) == ("healthy", 0, None)
    do(bench, FAULT)
    advance(bench, TICKS)
    bench.refresh_status()
    told = bench.status.supervisor
    assert told is not None and (told.kind, told.verdict, told.acting, told.acts) == ("switching", "m+5", "m+5", 1)
    (event,) = acts(bench)
    assert event.text.startswith("switch to pid: kalman has named m+5 for ")
    assert told.last_act is not None and told.last_act.text == "switches to PID"
    assert told.last_act.reason.startswith(f"kalman has named mass +{format_short(5.0, '%', 3)} for ")
    assert event.tick == told.last_act.tick and event.command == {"switch": "pid"}
    assert bench.status.controller == "pid"
    assert f"the supervisor switches to PID, because {told.last_act.reason}." in " ".join(sentences(bench))


def test_an_act_that_sets_values_is_told_by_the_title_of_the_controller() -> None:
    bench = supervised("retuning")
    advance(bench, 500)
    do(bench, FAULT)
    advance(bench, TICKS)
    bench.refresh_status()
    told, event = bench.status.supervisor, acts(bench)[-1]
    ratio = format_short(event.command["set"]["controllers.lqg.mass_ratio"], "", 4)
    assert told is not None and told.last_act is not None
    assert told.last_act.text.startswith(f"sets LQG to mass ×\u00a0{ratio}")
    assert f"the supervisor {told.last_act.text}, because the estimate of kalman has moved by" in " ".join(
        sentences(bench)
    )


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ({"switch": "adrc"}, "switches to Active disturbance rejection (ADRC)"),
        (
            {"set": {"controllers.lqg.mass_ratio": 1.05123, "sensor.kind": "ideal"}},
            "sets LQG to mass ×\u00a01.051 and ",
        ),
        ({"make_safe": "no hypothesis fits"}, "sets safe outputs"),
        ({"switch": "of_their_own"}, "switches to of_their_own"),
    ],
)
def test_an_act_in_words(command: dict[str, Any], said: str) -> None:
    assert act_words(command, PLAIN).startswith(said)


def test_a_live_run_is_the_run_of_its_document() -> None:
    bench = supervised(controllers={"m+5": "pid"})
    advance(bench, 500)
    do(bench, FAULT)
    advance(bench, 700)
    do(bench, {"set": {"reference.amplitude_v": 7.0}})
    advance(bench, TICKS)
    document = document_of(bench)
    assert [next(iter(event)) for event in document["events"]] == ["at_sample"] * 2
    again = run(Scenario.load(document))
    assert again.digest == bench.board.digest() and again.board.consequences == bench.board.consequences


def test_an_undo_leaves_its_acts_and_takes_back_what_a_person_did() -> None:
    bench = supervised(controllers={"m+5": "pid"})
    advance(bench, 500)
    do(bench, FAULT)
    advance(bench, 1000)
    assert bench.status.undo is not None and bench.status.undo.text == "inject added_mass +0.05"
    do(bench, {"kind": "undo"})
    assert not bench.board.faults and bench.board.spec.active == "pid"
    advance(bench, 1500)
    assert bench.board.spec.active == "lqg" and len(acts(bench)) == 2


def test_a_change_that_it_has_changed_since_is_not_taken_back() -> None:
    bench = supervised(controllers={"m+5": "pid"})
    advance(bench, 400)
    do(bench, {"switch": "adrc"})
    do(bench, FAULT)
    advance(bench, 1000)
    do(bench, {"kind": "undo"})  # the fault
    with pytest.raises(InputError, match=r"the supervisor has set controller\.kind since"):
        do(bench, {"kind": "undo"})
    assert bench.board.spec.active == "pid"


def test_values_before_a_command_at_the_tick_of_an_act_are_the_values_after_the_act() -> None:
    def healed(until: int) -> LiveBench:
        bench = supervised("scheduling")
        advance(bench, 500)
        do(bench, FAULT)
        advance(bench, 900)
        do(bench, {"heal": "all"})
        advance(bench, until)
        return bench

    edge, path = acts(healed(1500))[1].tick, "controllers.lqg.mass_ratio"
    bench = healed(edge)
    assert value_at(bench.board.spec, path) == 1.05 and len(acts(bench)) == 1
    do(bench, {"set": {path: 1.2}})
    assert value_at(bench.board.spec, path) == 1.2 and [event.tick for event in acts(bench)][1:] == [edge]
    do(bench, {"kind": "undo"})
    assert value_at(bench.board.spec, path) == 1.0


def test_safe_outputs_are_left_by_a_reset_and_come_again_while_the_fault_acts() -> None:
    bench = supervised("shutdown")
    advance(bench, 300)
    do(bench, FAULT)
    bench.advance(1000)
    while bench.board.trip is None and bench.advance(1000):
        pass
    assert bench.board.trip is not None and bench.board.trip.reason == "the supervisor trusts kalman, which names m+5"
    do(bench, {"reset_trip": True})
    tick = bench.board.tick
    while bench.board.trip is None and bench.advance(1000):
        pass
    assert bench.board.tick > tick and len(acts(bench)) == 2


def test_its_parameters_are_set_live_and_from_outside(live: Any) -> None:
    document = {**bench_document("switching", nominal="lqg", controllers={"m+5": "pid"}), "events": [{**FAULT, "at_sample": 400}]}  # fmt: skip  # noqa: E501
    bench = live.bench(document, paused=True, set={"supervisor.hold_ms": 2.0})
    assert bench["parameters"]["supervisor"]["hold_ms"] == 2.0
    assert live.command(bench["id"], set={"supervisor.hold_ms": 1.0}).status_code == 200
    live.command(bench["id"], "step", ticks=1500)
    status = live.get(bench["id"])
    assert status["supervisor"]["last_act"]["text"] == "switches to PID" and status["controller"] == "pid"
    # its past, another branch of it and the moment itself have the acts of the straight run
    for tick in (1000, 300, 1500):
        made = live.http.post(f"/api/v1/benches/{bench['id']}/fork", json={"tick": tick, "paused": True}).json()
        assert made["supervisor"]["acts"] == (tick > 450)
        assert made["controller"] == ("pid" if tick > 450 else "lqg")


def test_no_fault_is_hidden_where_its_acts_would_tell(live: Any) -> None:
    bench = live.bench(bench_document(), paused=True)
    answer = live.http.post(f"/api/v1/benches/{bench['id']}/blind", json={"seed": 1})
    assert answer.status_code == 422 and "supervisor" in answer.text

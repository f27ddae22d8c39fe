"""The narrator on live benches: as headless, in replays, after jumps; it tells no hidden fault."""

from __future__ import annotations

from typing import Any

import pytest

from core.board.commands import HealFaults
from scenarios.library import get
from scenarios.run import run
from server.bench.commands import parse
from server.bench.narration import NarrationPlace
from server.classroom.blind import hide
from server.classroom.hiding import ACTOR, OF_A_DIAGNOSER, SIGNALS, clear, hide_on
from tests.server.bench.test_session import advance, session
from tests.server.classroom.group import join, open_class


def narration(live: Any, bench: str, **query: Any) -> dict[str, Any]:
    answer = live.http.get(f"/api/v1/benches/{bench}/narration", params=query)
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


def headless(samples: int) -> list[dict[str, Any]]:
    scenario = get("ch5-seven-step")
    document = {key: value for key, value in scenario.document.items() if key != "expect"}
    found = run(type(scenario).load({**document, "samples": samples}), everything=True, narrate=True)
    return [said.model_dump(mode="json") for said in found.narration]


def stepped(live: Any, bench: str, ticks: int) -> None:
    while (left := ticks - live.get(bench)["tick"]) > 0:
        assert live.command(bench, "step", ticks=min(left, 1700)).status_code == 200


def test_a_live_bench_says_what_a_headless_run_says(live: Any) -> None:
    bench = live.bench(paused=True)["id"]
    assert narration(live, bench) == {"sentences": [], "after": 0, "last": 0, "jumps": 0}
    with live.stream(bench) as stream:
        first = stream.until_type("narration")
        assert (first["after"], first["sentences"]) == (0, [])
        stepped(live, bench, 3100)
        expected = headless(3100)
        heard: list[Any] = []
        while len(heard) < len(expected):
            message = stream.until_type("narration")
            assert message["after"] == len(heard)
            heard += message["sentences"]
    found = narration(live, bench)
    assert found["sentences"] == heard == expected and len(expected) == 4
    assert narration(live, bench, after=3)["sentences"] == expected[3:]
    assert narration(live, bench, after=3, jumps=7)["sentences"] == expected  # it has jumped since the seventh
    assert live.http.get(f"/api/v1/benches/{bench}/narration", params={"after": -1}).status_code == 422


def test_a_jump_takes_back_what_it_undoes(live: Any) -> None:
    bench = live.bench(paused=True)["id"]
    stepped(live, bench, 2500)
    kept = live.http.post(f"/api/v1/benches/{bench}/snapshots", json={"name": "one"}).json()["id"]
    before = narration(live, bench)
    stepped(live, bench, 4500)
    whole = narration(live, bench)["sentences"]
    assert len(whole) > len(before["sentences"]) == 2
    fork = live.http.post(f"/api/v1/benches/{bench}/fork", json={"snapshot": kept}).json()["id"]
    assert live.http.post(f"/api/v1/benches/{bench}/snapshots/{kept}/restore").status_code == 200
    for one in (bench, fork):
        now = narration(live, one)
        assert now["sentences"] == before["sentences"] and now["jumps"] == before["jumps"] + 1
        stepped(live, one, 4500)
        assert narration(live, one)["sentences"] == whole
    assert live.command(bench, "reset").status_code == 200
    assert narration(live, bench)["sentences"] == []


def test_a_trip_is_told_at_once_with_its_limit(live: Any) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    stepped(live, bench, 600)
    assert live.command(bench, set={"guard.travel_um": 0.1}).status_code == 200
    live.command(bench, "step", ticks=300)
    trip = live.get(bench)["trip"]
    (said,) = narration(live, bench)["sentences"]
    assert (said["kind"], said["tick"]) == ("trip", trip["tick"])
    assert said["numbers"] == {"time_ms": trip["time_ms"], "value": trip["value"], "limit": 0.1}


def test_a_replay_says_the_same_from_its_beginning(live: Any) -> None:
    bench = live.bench(paused=True)["id"]
    made = live.http.post(f"/api/v1/benches/{bench}/recordings", json={"name": "steps"}).json()["id"]
    stepped(live, bench, 4200)
    live.http.post(f"/api/v1/benches/{bench}/recordings/{made}/stop")
    replay = live.http.post(f"/api/v1/recordings/{made}/replay", json={"paused": True}).json()["id"]
    said = narration(live, replay)
    assert said["sentences"] == narration(live, bench)["sentences"] == headless(4200)
    live.command(replay, "step", ticks=3000)
    assert live.command(replay, "seek", tick=100).status_code == 200
    assert narration(live, replay) == said  # one plays over it, and scrubs, and it stays


@pytest.mark.parametrize("seeds", [(0,), pytest.param((1, 2, 3, 4), marks=pytest.mark.long)])
@pytest.mark.parametrize("shows", [False, True])
def test_nothing_is_said_that_tells_a_hidden_fault(live: Any, shows: bool, seeds: tuple[int, ...]) -> None:
    for seed in seeds:
        bench = live.bench("ch5-seven-step", set={"events": []}, paused=True)["id"]
        question = live.http.post(f"/api/v1/benches/{bench}/blind", json={"seed": seed, "shows": shows})
        assert question.is_success, question.text
        live.command(bench, switch="mrac")
        live.command(bench, "step", ticks=1000)
        live.command(bench, switch="open_loop")
        by = live.get(bench)["blind"]["by_tick"]
        while live.get(bench)["tick"] < by + 2000:
            live.command(bench, "step", ticks=1700)
        sentences = narration(live, bench)["sentences"]
        for said in sentences:
            assert said["kind"] in ("switch", "verdict", "settled")
            assert not {"truth", "delay_samples", "severity"} & set(said["numbers"])
            assert not any(word in said["text"] for word in ("fault", "truth", "right", "wrong", "healed"))
            for name in said["signals"]:
                block, _, port = name.partition(".")
                assert (shows and port.partition(".")[0] in OF_A_DIAGNOSER) or block in SIGNALS or name in SIGNALS
        assert [said["tick"] for said in sentences if said["kind"] == "switch"] == [0, 1000]
        if not shows:
            assert all(said["kind"] != "verdict" for said in sentences)
        live.http.delete(f"/api/v1/benches/{bench}/blind")
        whole = narration(live, bench)["sentences"]
        assert len(whole) >= len(sentences)
        live.http.delete(f"/api/v1/benches/{bench}")


def test_a_view_that_hides_a_fault_says_nothing_of_the_error() -> None:
    """The controller drives without an error until the fault comes, and again once it is healed."""
    bench = session("ch5-seven-step", events=[], samples=10_000)
    question = hide(bench.board, bench.scenario.document, "q", False, 0, 0.0)
    fault = {"fault": "added_mass", "severity": 0.5}
    clear(bench)
    hide_on(bench, question.model_copy(update={"faults": [fault], "came_tick": 2000}), "board")
    advance(bench, 1000)
    bench.execute(parse({"switch": "mrac"}), "test")
    advance(bench, 3000)
    bench.board.apply(HealFaults(heal="all"), ACTOR)
    advance(bench, 4000)
    view = bench.view
    assert view is not None
    whole, told = (one.narration.after(NarrationPlace())[2] for one in (bench, view))
    since = [said.text.rpartition(" ")[2] for said in whole if said.kind == "settled"]
    assert since == ["fault.", "healing."]
    assert [(said.kind, said.tick, said.signals) for said in told] == [("switch", 1000, [])]
    assert all("error" not in said.text and "error_um" not in said.numbers for said in told)


def test_a_teacher_hears_all_of_the_bench_of_a_student(live: Any) -> None:
    group = open_class(live)
    ada = join(live, group, "Ada")
    live.http.post(f"/api/v1/classes/{group['id']}/blind", json={})
    ada.bench = ada.ask("GET", "/api/v1/me").json()["bench"]
    live.command(ada.bench, "time_scale", value=0.1)
    live.until(ada.bench, lambda bench: bench["tick"] > 4000)
    answer = ada.ask("GET", f"/api/v1/benches/{ada.bench}/narration")
    assert answer.status_code == 200 and answer.json()["sentences"] == []
    truth = live.http.get(f"/api/v1/classes/{group['id']}/blind").json()["answers"][0]["truth"]
    if truth != "healthy":
        live.until(ada.bench, lambda bench: bench["pending"] == [])
        assert any(said["kind"] == "fault" for said in narration(live, ada.bench)["sentences"])
        assert ada.ask("GET", f"/api/v1/benches/{ada.bench}/narration").json()["sentences"] == []
    live.http.delete(f"/api/v1/classes/{group['id']}")

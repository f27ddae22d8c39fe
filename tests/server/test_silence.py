"""When the engine hangs or breaks off: safe outputs, a trip on every page, the last seconds kept, and a restart."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import pytest

from core.board.history import History
from core.board.stored import revived
from scenarios.run import run
from scenarios.schema import Scenario
from server.bench import watchdog
from tests.server.bench.test_engine import until
from tests.server.classroom.group import join, open_class
from tests.server.classroom.test_blind import hide
from tests.server.conftest import Live
from tests.server.test_metrics import metrics

LONG: dict[str, Any] = {"set": {"events": [], "samples": 10_000_000}, "time_scale": 0.01}


@pytest.fixture
def live(serve: Any) -> Iterator[Live]:
    """A separate server: no other test should meet a trip."""
    with serve(run_workers=0, clock="machine") as found:
        yield found


@contextmanager
def hanging(live: Live) -> Iterator[None]:
    """Let the engine hang in a job."""
    let_go, begun = threading.Event(), threading.Event()

    def hang() -> None:
        begun.set()
        let_go.wait()

    live.service.engine.submit(hang)
    assert begun.wait(30)
    try:
        yield
    finally:
        let_go.set()


def running(live: Live, **fields: Any) -> str:
    """Make a bench, and wait until it has run for a while."""
    bench = str(live.bench("first-look", **{**LONG, **fields})["id"])
    live.until(bench, lambda one: one["tick"] > 100)
    return bench


def recordings(live: Live, count: int) -> list[dict[str, Any]]:
    """Return the recordings, once so many have ended."""
    found: list[dict[str, Any]] = []

    def ended() -> bool:
        found[:] = live.http.get("/api/v1/recordings").json()["recordings"]
        return sum(one["state"] == "done" for one in found) == count

    until(ended)
    return found


def goes_on(live: Live, bench: str) -> None:
    """Reset the trip of a bench, and see that it runs again."""
    assert live.command(bench, reset_trip=True).status_code == 200
    assert live.command(bench, "start").status_code == 200
    tick = live.get(bench)["tick"]
    live.until(bench, lambda one: one["tick"] > tick and one["state"] == "running")


def test_pages_see_the_trip_while_the_engine_hangs_and_the_run_repeats_with_the_same_bits(live: Live) -> None:
    bench = running(live)
    with live.stream(bench) as stream:
        stream.until_type("hello")
        with hanging(live):
            status = stream.until_type("status", state="tripped")
            assert status["trip"]["reason"].startswith("the engine gave no sign for ")
            assert status["trip"]["reason"].endswith("; outputs were taken to safe values")
            assert live.get(bench)["trip"] == status["trip"]
            bad = live.http.get("/health/ready")
            assert bad.status_code == 503 and bad.json()["checks"]["engine"] is False
        event = stream.until_event(kind="make_safe")
    assert event["actor"] == "board" and event["command"]["make_safe"] == status["trip"]["reason"]
    after = live.get(bench)
    assert after["state"] == "tripped" and after["trip"]["tick"] == event["tick"] == after["tick"]
    assert live.service.benches.get(bench).board.value("drive.voltage") == 0.0
    goes_on(live, bench)
    live.command(bench, "pause")
    document = live.http.get(f"/api/v1/benches/{bench}/scenario").text
    digest = live.http.get(f"/api/v1/benches/{bench}/digest").json()
    result = run(Scenario.load(document))
    assert (result.board.tick, result.digest) == (digest["tick"], digest["digest"])
    assert live.http.get("/health/ready").status_code == 200
    assert metrics(live)["combbench_watchdog_trips_total"] == 1


def test_the_last_two_seconds_are_a_recording_with_the_trip_in_it(live: Live) -> None:
    bench = running(live)
    live.until(bench, lambda one: one["tick"] > 3000)
    with hanging(live):
        live.until(bench, lambda one: one["state"] == "tripped")
    (kept,) = recordings(live, 1)
    trip = live.get(bench)["trip"]
    assert kept["bench_id"] == bench and kept["name"].startswith("before the trip: the engine gave no sign for ")
    assert kept["start_tick"] + kept["ticks"] == trip["tick"]
    assert kept["ticks"] * kept["dt_ms"] == pytest.approx(2.0 * 0.01 * 1e3, rel=0.3)
    detail = live.http.get(f"/api/v1/recordings/{kept['id']}").json()
    assert [event["kind"] for event in detail["events"]][-2:] == ["make_safe", "recording_started"]
    replay = live.http.post(f"/api/v1/recordings/{kept['id']}/replay", json={"paused": True})
    assert replay.status_code == 201


def test_a_recording_that_is_played_does_not_trip(live: Live) -> None:
    bench = running(live)
    with hanging(live):
        live.until(bench, lambda one: one["state"] == "tripped")
    (kept,) = recordings(live, 1)
    made = live.http.post(f"/api/v1/recordings/{kept['id']}/replay", json={"speed": 0.01}).json()["id"]
    with hanging(live):
        until(lambda: bool(live.service.watchdog.barks))
        assert live.get(made)["state"] == "running"
    live.until(made, lambda one: one["tick"] > one["first_tick"])
    assert metrics(live)["combbench_watchdog_trips_total"] == 1


def test_a_dead_thread_trips_its_benches_and_asks_for_a_restart(live: Live) -> None:
    bench = running(live)

    def die() -> None:
        raise SystemExit

    live.service.engine.submit(die)
    live.until(bench, lambda one: one["state"] == "tripped" and one["is_stuck"])
    assert live.get(bench)["trip"]["reason"] == "the engine broke off; outputs were taken to safe values"
    health = live.http.get("/health/live")
    assert health.status_code == 503 and health.json()["checks"] == {"event_loop": True, "engine": False}


def stick(live: Live, bench: str) -> Callable[[], None]:
    """Let the next slice of a bench hang; return the function that releases it."""
    let_go, board = threading.Event(), live.service.benches.get(bench).board
    real = board.advance_into

    def advance(history: History, ticks: int) -> Any:
        let_go.wait()
        return real(history, ticks)

    board.advance_into = advance

    def free() -> None:
        board.advance_into = real
        let_go.set()

    return free


def test_a_bench_whose_tick_hangs_is_named_kept_first_and_goes_on_once_it_comes_back(
    live: Live, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(watchdog, "MOST_KEPT", 1)
    other, stuck = running(live), running(live)
    free = stick(live, stuck)
    try:
        for bench in (stuck, other):
            live.until(bench, lambda one: one["state"] == "tripped")
        assert "in a tick of this bench" in live.get(stuck)["trip"]["reason"]
        assert f"held up by bench {stuck}" in live.get(other)["trip"]["reason"]
    finally:
        free()
    for bench in (stuck, other):
        goes_on(live, bench)
    assert [one["bench_id"] for one in recordings(live, 1)] == [stuck]


def test_a_bench_that_is_stuck_for_good_asks_for_a_restart_and_does_not_come_back(
    serve: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(watchdog, "STUCK_S", 0.5)
    with ExitStack() as afterwards:
        with serve(run_workers=0, clock="machine", data=tmp_path) as live:
            stuck, other = running(live), running(live)
            for bench in (stuck, other):
                until((tmp_path / "benches" / f"{bench}.npz").exists)
            afterwards.callback(stick(live, stuck))  # it hangs until its server has ended
            with live.stream(other) as stream:
                stream.until_type("status", is_stuck=True)
            assert live.http.get("/health/live").status_code == 503
            until((tmp_path / "benches" / f"{stuck}.hung").exists)
    with serve(run_workers=0, clock="machine", data=tmp_path) as live:
        assert live.http.get(f"/api/v1/benches/{stuck}").status_code == 404
        assert live.get(other)["tick"] > 0
        assert live.http.get("/health/live").status_code == 200


def test_a_bench_that_moves_again_comes_back_and_the_page_says_so(
    serve: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(watchdog, "STUCK_S", 0.5)
    with serve(run_workers=0, clock="machine", data=tmp_path) as live:
        stuck, still = running(live), live.bench("first-look", paused=True)["id"]
        renamed = live.http.patch(f"/api/v1/benches/{still}", json={"name": "with PID"})
        assert renamed.status_code == 200
        free = stick(live, stuck)
        with live.stream(still) as stream:
            stream.until_type("status", is_stuck=True)
            until((tmp_path / "benches" / f"{stuck}.hung").exists)
            free()
            stream.until_type("status", is_stuck=False)
    with serve(run_workers=0, clock="machine", data=tmp_path) as live:
        live.until(stuck, lambda one: one.get("tick", 0) > 100)
        assert live.get(still)["name"] == "with PID"


def test_benches_of_students_trip_too_and_their_checkpoints_say_so(live: Live) -> None:
    group = open_class(live)
    ada = join(live, group, "Ada")
    live.until(ada.bench, lambda one: one["tick"] > 100)
    with hanging(live):
        live.until(ada.bench, lambda one: one["state"] == "tripped")
    session = live.service.benches.get(ada.bench)
    until(lambda: session.board.trip is not None)
    path = live.service.settings.data / "benches" / f"{ada.bench}.npz"
    checkpoints = live.service.checkpoints

    def kept() -> Any:
        return live.on_loop(checkpoints.load(ada.bench)) if path.exists() else None

    until(lambda: (found := kept()) is not None and found.stored.document["trip"] is not None)
    found = kept()
    assert revived(found.stored).trip == session.board.trip and not found.head.running
    assert "make_safe" in {event.kind for event in found.events}
    (recording,) = recordings(live, 1)
    assert recording["bench_id"] == ada.bench


def test_of_a_bench_with_a_hidden_fault_no_recording_tells(live: Live) -> None:
    group = open_class(live)
    ada = join(live, group, "Ada")
    hide(live, group, ada)
    open_bench = running(live)
    live.until(ada.bench, lambda one: one["tick"] > 100)
    with hanging(live):
        live.until(ada.bench, lambda one: one["state"] == "tripped")
        told = ada.ask("GET", f"/api/v1/benches/{ada.bench}").json()["trip"]
        assert told["reason"] == "the board has stopped itself"
    (kept,) = recordings(live, 1)
    assert kept["bench_id"] == open_bench


def test_safe_outputs_are_never_refused_for_what_waits(live: Live) -> None:
    bench = running(live)
    for number in range(100):
        assert live.command(bench, fault="damping", severity=0.1, at_sample=9_000_000 + number).status_code == 200
    assert live.command(bench, fault="damping", severity=0.1).json()["error"]["code"] == "limit"
    with hanging(live):
        live.until(bench, lambda one: one["state"] == "tripped")
    until(lambda: live.service.benches.get(bench).board.trip is not None)


def test_a_poisoned_board_trips_by_itself(live: Live) -> None:
    bench = running(live)
    board = live.service.benches.get(bench).board

    def poison() -> int:
        board.wiring.w[board.wiring.index["plant.displacement"]] = float("nan")
        return int(board.tick)

    tick = live.service.engine.submit(poison).result(30)
    live.until(bench, lambda one: one["state"] == "tripped")
    trip = live.get(bench)["trip"]
    assert trip["tick"] == tick + 1 and "not a finite number" in trip["reason"]
    assert metrics(live)["combbench_watchdog_trips_total"] == 0

"""The event log: numbers without gaps, and a true count of forgotten events."""

from __future__ import annotations

from server.bench import events as module
from server.bench.events import Event, EventLog


def test_events_are_numbered_from_one_and_replayed_from_anywhere() -> None:
    told: list[Event] = []
    log = EventLog(told.append)
    for tick in range(5):
        log.add(tick, "test", "kind", f"event {tick}")
    assert [event.seq for event in log.after(0)[1]] == [1, 2, 3, 4, 5]
    assert [event.seq for event in log.after(3)[1]] == [4, 5]
    assert [event.seq for event in log.after(1, 2)[1]] == [2, 3]
    assert log.after(5) == (0, [])
    assert log.last == 5 and told == log.after(0)[1]


def test_what_is_forgotten_is_counted() -> None:
    log = EventLog(lambda _: None)
    for tick in range(module.KEPT + 100):
        log.add(tick, "test", "kind", "event")
    lost, events = log.after(40)
    assert lost == 60
    assert [events[0].seq, events[-1].seq] == [101, module.KEPT + 100]
    assert log.after(100, 1)[0] == 0

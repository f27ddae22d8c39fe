"""Cost of pages that watch a bench, in this process: pictures are cut, encoded and framed, and go nowhere."""

from __future__ import annotations

from typing import Any

from core.format import format_count
from scenarios.library import get
from scenarios.run import build
from scenarios.speed.figure import figure, scaled
from scenarios.speed.timing import cpu_ns, interleaved
from server.bench.bench import LiveBench
from server.metrics import Metrics
from server.stream.client import Client
from server.stream.hub import Room
from server.stream.panel import Panel
from server.stream.wire import Subscribe

WATCHERS = 1, 50, 200
ROUNDS = 30
"""Pictures of one measurement."""
TICKS = 1667
"""Between two pictures at 60 Hz and 100 kHz."""
SIGNALS = ["reference.voltage", "drive.voltage", "plant.displacement", "sensor.displacement"]


class _Line:
    """A line that takes everything at once."""

    is_free = True
    waiting = passed_on = 0

    def write(self, data: bytes) -> None:
        """Take messages."""
        self.passed_on += len(data)


class Watched:
    """A bench with pages that show the same four traces and acknowledge every picture."""

    def __init__(self, watchers: int) -> None:
        scenario, self.metrics = get("first-look"), Metrics()
        self._session = LiveBench(scenario, build(scenario), None, 20 * TICKS, self.metrics, lambda: 0.0)
        self._session.begin(True)
        self._room = Room(self._session, dict)
        wanted = Subscribe(type="subscribe", panel=1, signals=SIGNALS, mode="roll", window_ms=4.0, width=800)
        for _ in range(watchers):
            line: Any = _Line()
            room, last = self._room, self._session.events.last
            client = Client(line, self._session, self.metrics.sent, room.news, room.cuts, last)
            client.panels[1] = Panel(room.cuts.view(wanted, self._session.indices(SIGNALS), None), 1)
            self._room.clients.add(client)

    def cost(self) -> float:
        """Return the time of one picture for all pages, ns."""
        return sum(self._picture() for _ in range(ROUNDS)) / ROUNDS

    def _picture(self) -> float:
        self._session.advance(TICKS)
        return cpu_ns(self._show, 1)

    def _show(self) -> None:
        for _ in self._room.publish(0.0):
            pass
        for client in self._room.clients:
            client.acknowledge(1 << 31)


def watchers() -> list[dict[str, Any]]:
    """Measure one picture for some numbers of watchers, and a further watcher over the first."""
    costs = interleaved({str(count): Watched(count).cost for count in WATCHERS})
    first, _, last = (str(count) for count in WATCHERS)
    further = [(many - one) / (WATCHERS[-1] - 1) / one for one, many in zip(costs[first], costs[last], strict=True)]
    names = {
        count: f"picture of a first look for {format_count(count, 'watcher')}, without the network"
        for count in WATCHERS
    }
    return [figure(name, scaled(costs, str(count), 1e-3), "us") for count, name in names.items()] + [
        figure("a further watcher over the first", further, "x", most=0.1)
    ]

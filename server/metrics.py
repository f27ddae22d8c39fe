"""Every metric of the service, in one registry per application."""

from __future__ import annotations

from collections.abc import Iterable

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, Metric, generate_latest
from prometheus_client.core import CounterMetricFamily
from prometheus_client.registry import Collector

FINE = (0.0001, 0.0002, 0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.5, 1.0)


class Sent(Collector):
    """Frames and bytes sent on all streams, as plain integers: 200 pages add to them twelve thousand times a second."""

    def __init__(self) -> None:
        self.frames = self.frame_bytes = self.frames_dropped = 0

    def collect(self) -> Iterable[Metric]:
        """Return the counters."""
        yield CounterMetricFamily("combbench_stream_frames", "Frames sent", self.frames)
        yield CounterMetricFamily("combbench_stream_frame_bytes", "Bytes of frames sent", self.frame_bytes)
        yield CounterMetricFamily(
            "combbench_stream_frames_dropped", "Frames clients were too slow for", self.frames_dropped
        )


class Metrics:
    """Counters, gauges and histograms; no label has unbounded values."""

    def __init__(self) -> None:
        registry = self.registry = CollectorRegistry()
        self.wake_lateness = Histogram(
            "combbench_engine_wake_lateness_seconds",
            "How late the engine thread woke for a round",
            buckets=FINE,
            registry=registry,
        )
        self.watchdog_trips = Counter(
            "combbench_watchdog_trips",
            "Times that benches were taken to safe outputs because the engine hung",
            registry=registry,
        )
        self.round_seconds = Histogram(
            "combbench_engine_round_seconds", "Board work of one round", buckets=FINE, registry=registry
        )
        self.loop_lag = Histogram(
            "combbench_event_loop_lag_seconds",
            "How late a timer of the event loop fired",
            buckets=FINE,
            registry=registry,
        )
        self.ticks = Counter("combbench_ticks", "Board ticks computed", registry=registry)
        self.overruns = Counter("combbench_overruns", "Rounds in which a bench missed its target", registry=registry)
        self.given_up_seconds = Counter(
            "combbench_time_given_up_seconds", "Wall time benches gave up catching up", registry=registry
        )
        self.benches = Gauge("combbench_benches", "Live benches", ["state"], registry=registry)
        self.clients = Gauge("combbench_stream_clients", "Open streams", registry=registry)
        self.sent = Sent()
        registry.register(self.sent)
        self.streams_closed = Counter(
            "combbench_streams_closed", "Streams closed by the server", ["reason"], registry=registry
        )
        self.commands = Counter("combbench_commands", "Commands", ["kind", "result"], registry=registry)
        self.events = Counter("combbench_events", "Events of all benches", ["kind"], registry=registry)
        self.runs = Counter("combbench_runs", "Headless runs ended", ["state"], registry=registry)
        self.recorded_ticks = Counter("combbench_recorded_ticks", "Ticks written to recordings", registry=registry)

    def text(self) -> bytes:
        """Return the exposition."""
        return generate_latest(self.registry)

"""Metrics and health: the view of an operator."""

from __future__ import annotations

from typing import Any

from prometheus_client.parser import text_string_to_metric_families


def metrics(live: Any) -> dict[str, float]:
    text = live.http.get("/metrics").text
    return {
        sample.name + "".join(f"|{value}" for key, value in sorted(sample.labels.items()) if key != "le"): sample.value
        for family in text_string_to_metric_families(text)
        for sample in family.samples
    }


def test_every_metric_has_our_prefix_and_counts(serve: Any) -> None:
    with serve() as live:
        before = metrics(live)
        assert all(name.startswith("combbench_") for name in before)
        bench = live.bench(set={"events": []})
        live.command(bench["id"], fault="damping", severity=0.3)
        live.command(bench["id"], heal=["added_mass"])
        with live.stream(bench["id"]) as stream:
            stream.send(type="subscribe", panel=1, signals=["plant.displacement"], window_ms=1.0)
            live.advance(bench=bench["id"], ticks=20)
            stream.settle()
            during = metrics(live)
        assert during["combbench_benches|running"] == 1
        assert during["combbench_stream_clients"] == 1
        assert during["combbench_stream_frames_total"] >= 1
        assert during["combbench_commands_total|inject|done"] == 1
        assert during["combbench_commands_total|heal|refused"] == 1
        assert during["combbench_ticks_total"] > 0
        assert during["combbench_engine_wake_lateness_seconds_count"] > 0
        live.advance(seconds=0.2)
        after = live.wait(lambda: (now := metrics(live))["combbench_stream_clients"] == 0 and now)
        assert after["combbench_ticks_total"] > during["combbench_ticks_total"]
        live.wait(lambda: metrics(live)["combbench_event_loop_lag_seconds_count"] > 5)


def test_metrics_may_be_opened_by_a_setting_and_health_says_what_is_wrong(serve: Any) -> None:
    with serve(metrics_open=True) as live, live.anonymous() as stranger:
        assert stranger.get("/metrics").status_code == 200
        assert stranger.get("/api/v1/benches").status_code == 401
        good = stranger.get("/health/ready")
        assert good.status_code == 200
        assert good.json() == {
            "ok": True,
            "checks": {"started": True, "engine": True, "watchdog": True, "database": True, "kernels": True},
        }
        live.service.kernels.are_loaded = False
        bad = stranger.get("/health/ready")
        assert bad.status_code == 503 and bad.json()["checks"]["kernels"] is False
        assert stranger.get("/health/live").status_code == 200

"""The read-out of a live gyroscope: the route agrees with its signals."""

from __future__ import annotations

import pytest

GYROSCOPE = {
    "schema": 1,
    "id": "gyroscope",
    "seed": 4,
    "device": {"id": "gyro-c"},
    "controller": {"kind": "open_loop_rate"},
    "rate": {"kind": "noise", "angle_random_walk_deg_rt_h": 5.0, "bias_instability_deg_h": 0.0},
    "readouts": {"allan": {"kind": "allan", "interval_ms": 5.0, "skip_ms": 2000.0}},
}


def readout(live, bench, name="allan"):
    return live.http.get(f"/api/v1/benches/{bench['id']}/readouts/{name}")


def test_the_record_so_far_in_deg_h_with_what_it_tells(live):
    bench = live.bench({**GYROSCOPE, "samples": 600_000}, time_scale=1.0)
    live.until(bench["id"], lambda status: status["state"] == "paused")
    found = readout(live, bench).json()
    assert found["tick"] == 600_000 and found["record_s"] == pytest.approx(4.0)
    octaves = found["octaves"]
    # two means of 1.28 s fit into 4 s, two of 2.56 s do not
    assert [octave["tau_s"] for octave in octaves] == pytest.approx([0.005 * 2**j for j in range(9)])
    assert [octave["pairs"] for octave in octaves][:2] == [800 - 1, 800 - 3]

    signals = [f"allan.deviation.{2**j}" for j in range(9)]
    query = {"signals": ",".join(signals), "start_tick": 599_999, "end_tick": 600_000, "columns": 1}
    trace = live.http.get(f"/api/v1/benches/{bench['id']}/trace", params=query).json()
    latest = [trace["signals"][signal]["max"][-1] for signal in signals]
    assert [octave["deviation_deg_h"] for octave in octaves] == pytest.approx([3600.0 * v for v in latest])

    assert [(figure["letter"], figure["unit"], figure["true"]) for figure in found["figures"]] == [
        ("N", "deg/rt h", 5.0),
        ("B", "deg/h", 0.0),
        ("K", "deg/h/rt h", 10.0),
    ]
    for figure in found["figures"]:
        assert (figure["value"] is None) == ("needs" in figure["reason"]) and figure["error"] > 0.0
    assert octaves[0]["tau_s"] <= found["from_s"] < found["to_s"] <= 4.0 / 9


def test_a_record_that_is_too_short_says_how_long_it_must_be(live):
    bench = live.bench(GYROSCOPE, paused=True)
    found = readout(live, bench).json()
    assert found["record_s"] == 0.0 and found["octaves"] == [] and found["from_s"] == 0.0
    # four octaves, the longest nine times: 9 * 8 * 5 ms
    assert all(figure["value"] is None and "0.360\u00a0s" in figure["reason"] for figure in found["figures"])
    assert [figure["error"] for figure in found["figures"]] == [None] * 3


def test_a_name_that_is_none_is_refused_with_those_there_are(live):
    answer = readout(live, live.bench(GYROSCOPE, paused=True), "alan")
    assert answer.status_code == 422
    error = answer.json()["error"]
    assert error["field"] == "name" and "allan" in error["message"] + error["hint"]


def test_a_resonator_has_none(live):
    answer = readout(live, live.bench("first-look", paused=True))
    assert answer.status_code == 422

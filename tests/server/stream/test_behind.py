"""Other benches behind the picture of a panel: the same signals, shifted by whole ticks."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from tests.server.classroom.group import join, open_class

NAMES = ["plant.displacement", "drive.voltage"]


def stepped(live: Any, ticks: int, **fields: Any) -> str:
    bench: str = live.bench(paused=True, **fields)["id"]
    live.command(bench, "step", ticks=ticks)
    return bench


def samples(live: Any, bench: str, start: int, end: int) -> np.ndarray:
    """Each sample by the door for traces, as minimum and maximum of a column of its own."""
    ask = {"signals": ",".join(NAMES), "start_tick": start, "end_tick": end, "format": "parquet"}
    answer = live.http.get(f"/api/v1/benches/{bench}/trace", params=ask)
    assert answer.status_code == 200, answer.text
    table = pq.read_table(io.BytesIO(answer.content))
    values = np.array([table.column(name).to_numpy() for name in NAMES], np.float32)
    return np.stack([values, values], axis=1)


@pytest.mark.parametrize("shift", [0, 37, -150])
def test_the_bench_behind_has_its_own_samples_shifted(live: Any, shift: int) -> None:
    bench, other = stepped(live, 500), stepped(live, 700, seed=5)
    live.command(other, fault="added_mass", severity=0.1)
    live.command(other, "step", ticks=200)
    with live.stream(bench) as stream:
        behind = [{"bench": other, "shift_ticks": shift}]
        stream.send(type="subscribe", panel=7, signals=NAMES, window_ms=4.0, width=200, behind=behind)
        (panel,) = stream.until_frame(7).panels
        assert panel.columns.shape == (4, 2, 200) and (panel.start, panel.end) == (300, 500)
        np.testing.assert_array_equal(panel.columns[:2], samples(live, bench, 300, 500))
        np.testing.assert_array_equal(panel.columns[2:], samples(live, other, 300 + shift, 500 + shift))
        assert not np.array_equal(panel.columns[:2], panel.columns[2:])
        assert np.isfinite(panel.latest[:2]).all() and np.isnan(panel.latest[2:]).all()


def test_a_bench_behind_that_goes_on_is_drawn_again_and_one_that_is_gone_leaves_nothing(live: Any) -> None:
    bench, other = stepped(live, 500), stepped(live, 100)
    with live.stream(bench) as stream:
        stream.send(type="subscribe", panel=1, signals=NAMES, window_ms=4.0, width=200, behind=[{"bench": other}])
        (panel,) = stream.until_frame(1).panels
        assert np.isnan(panel.columns[2:]).all()
        live.command(other, "step", ticks=250)
        (panel,) = stream.until_frame(1).panels
        # the histories of two benches of one scenario and seed are alike
        np.testing.assert_array_equal(panel.columns[2:, :, :50], panel.columns[:2, :, :50])
        assert np.isnan(panel.columns[2:, :, 50:]).all()
        assert live.http.delete(f"/api/v1/benches/{other}").status_code == 204
        live.command(bench, "step", ticks=1)
        (panel,) = stream.until_frame(1).panels
        assert np.isnan(panel.columns[2:]).all() and np.isfinite(panel.columns[:2]).all()


def test_signals_that_the_other_lacks_are_left_out(live: Any) -> None:
    bench, other = stepped(live, 300), stepped(live, 300, set={"diagnosers": {}, "expect": []})
    assert "kalman.winner" not in {signal["name"] for signal in live.get(other)["signals"]}
    with live.stream(bench) as stream:
        names = ["plant.displacement", "kalman.winner"]
        stream.send(type="subscribe", panel=1, signals=names, window_ms=2.0, width=50, behind=[{"bench": other}])
        (panel,) = stream.until_frame(1).panels
        assert np.isfinite(panel.columns[2]).all() and np.isnan(panel.columns[3]).all()


def test_what_cannot_be_behind_is_refused_in_one_line(live: Any) -> None:
    bench = stepped(live, 50)
    slower = stepped(live, 50, set={"sample_rate_khz": 25})
    with live.stream(bench) as stream:
        ask = {"type": "subscribe", "panel": 1, "signals": NAMES, "window_ms": 1.0, "width": 50}
        for behind, field, words in (
            ([{"bench": "nobody"}], "behind.0.bench", "no bench 'nobody'"),
            ([{"bench": bench}, {"bench": slower}], "behind.1.bench", "25 kHz"),
            ([{"bench": bench}] * 9, "behind", "8"),
            ([{"bench": bench, "shift_ticks": 0.5}], "behind.0.shift_ticks", "integer"),
        ):
            stream.send(**ask, behind=behind)
            error = stream.until_type("error")["error"]
            assert error["field"] == field and words in error["message"], error
        names = [signal["name"] for signal in live.get(bench)["signals"]][:32]
        stream.send(**{**ask, "signals": names, "width": 4096}, behind=[{"bench": bench}] * 8)
        assert "262144" in stream.until_type("error")["error"]["message"]


def test_nobody_sees_behind_a_panel_what_the_bench_itself_would_not_show(live: Any) -> None:
    group = open_class(live)
    ada, bob = join(live, group, "Ada"), join(live, group, "Bob")
    teachers = stepped(live, 100, scenario="first-look")
    assert live.get(teachers)["dt_ms"] == live.get(ada.bench)["dt_ms"]
    with ada.stream() as stream:
        for other in (bob.bench, teachers):
            ask = {"signals": ["plant.displacement"], "window_ms": 1.0, "width": 50}
            stream.send(type="subscribe", panel=1, **ask, behind=[{"bench": other}])
            error = stream.until_type("error")["error"]
            assert (error["code"], error["field"]) == ("not_found", "behind.0.bench")
    with live.stream(teachers) as stream:
        stream.send(type="subscribe", panel=1, **ask, behind=[{"bench": ada.bench}])
        assert stream.until_frame(1).panels[0].columns.shape[0] == 2
    live.http.delete(f"/api/v1/classes/{group['id']}")


def test_a_hidden_fault_stays_hidden_behind_a_panel(live: Any) -> None:
    bench = stepped(live, 100)
    hidden = stepped(live, 100)
    assert live.http.post(f"/api/v1/benches/{hidden}/blind", json={"seed": 1}).is_success
    live.command(hidden, "step", ticks=100)
    names = [signal["name"] for signal in live.get(bench)["signals"]][:32]
    seen = {signal["name"] for signal in live.get(hidden)["signals"]}
    assert "plant.displacement" not in seen and set(names) & seen
    with live.stream(bench) as stream:
        ask = {"signals": names, "window_ms": 1.0, "width": 50}
        stream.send(type="subscribe", panel=1, **ask, behind=[{"bench": hidden, "shift_ticks": 100}])
        (panel,) = stream.until_frame(1).panels
        for name, behind in zip(names, panel.columns[len(names) :], strict=True):
            assert (np.isfinite(behind) if name in seen else np.isnan(behind)).all(), name
    live.http.delete(f"/api/v1/benches/{hidden}")

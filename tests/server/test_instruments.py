"""Instruments that send their samples: the bench plays them, keeps them, waits for one that is gone, and refuses."""

from __future__ import annotations

import json
import socket
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from core.measured_record import MeasuredRecord, find_on
from scenarios.library import get
from scenarios.records import live
from scenarios.records.bench import on_record
from scenarios.records.shelf import RecordFolder
from scenarios.run import run
from scenarios.schema import Scenario
from server.instruments.source import Source
from tests.scenarios.records.foreign import draw
from tests.server.conftest import Live, serving
from tests.server.instrument import FakeInstrument

SAMPLES = 1500


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Live]:
    folder = tmp_path_factory.mktemp("instruments")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COMBBENCH_RECORDS", str(folder / "records"))
        with serving(folder, instrument_port=0, instrument_samples=20_000) as live:
            yield live
    find_on(RecordFolder())


@pytest.fixture
def listens(server: Live) -> Iterator[str]:
    yield server.http.get("/api/v1/instruments").json()["listens"]
    for bench in server.http.get("/api/v1/benches").json()["benches"]:
        server.http.delete(f"/api/v1/benches/{bench['id']}")
    server.advance(seconds=1.5)


@pytest.fixture(scope="module")
def measured() -> tuple[Any, Any]:
    """Drive and displacement of the seven steps."""
    document = {name: value for name, value in get("ch5-seven-step").document.items() if name != "expect"}
    found = run(Scenario.load({**document, "samples": SAMPLES}))
    return np.array(found.signal("drive.voltage")), np.array(found.signal("sensor.displacement"))


def source(live: Live, name: str = "scope") -> dict[str, Any]:
    found = live.http.get("/api/v1/instruments").json()["instruments"]
    return next((one for one in found if one["name"] == name), {})


def opened(live: Live, name: str = "scope", **body: Any) -> dict[str, Any]:
    answer = live.http.post(f"/api/v1/instruments/{name}/benches", json={"scenario": "ch5-seven-step", **body})
    assert answer.status_code == 201, answer.text
    found: dict[str, Any] = answer.json()
    return found


def digest(live: Live, bench: dict[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = live.http.get(f"/api/v1/benches/{bench['id']}/digest").json()
    return found


def played(live: Live, bench: dict[str, Any], tick: int) -> dict[str, Any]:
    """Return the bench once it has played the samples before a tick."""
    live.until(bench["id"], lambda one: one["tick"] >= tick)
    return live.get(bench["id"])


@pytest.mark.parametrize("sizes", [(1, 37, 512), (1500,)])
def test_blocks_of_any_size_give_the_digest_of_the_whole_record(
    sizes: tuple[int, ...], server: Live, listens: str, measured: tuple[Any, Any]
) -> None:
    drive, displacement = measured
    with FakeInstrument(listens) as scope:
        assert scope.begin() == {"ok": True}
        bench = opened(server)
        at = number = 0
        while at < SAMPLES:
            end = min(SAMPLES, at + sizes[number % len(sizes)])
            scope.block(number, at, drive[at:end], displacement[at:end])
            at, number = end, number + 1
        status = played(server, bench, SAMPLES)
    assert status["instrument"]["samples"] == SAMPLES and status["instrument"]["blocks"] == number
    record = MeasuredRecord(50.0, drive.copy(), displacement.copy())
    RecordFolder().keep(record)
    whole = run(Scenario.load(on_record(get("ch5-seven-step"), record)))
    assert digest(server, bench) == {"tick": SAMPLES, "digest": whole.digest}
    # the scenario of the bench gives the same bits headless, from the record that has grown
    text = server.http.get(f"/api/v1/benches/{bench['id']}/scenario").text
    assert run(Scenario.load(text)).digest == whole.digest


def test_an_instrument_that_is_gone_is_awaited_and_goes_on(
    server: Live, listens: str, measured: tuple[Any, Any]
) -> None:
    drive, displacement = measured
    with FakeInstrument(listens, session="one") as scope:
        scope.begin()
        bench = opened(server)
        scope.block(0, 0, drive[:100], displacement[:100])
        played(server, bench, 100)
    server.until(bench["id"], lambda one: not one["instrument"]["is_connected"])
    assert server.get(bench["id"])["state"] == "running"
    with FakeInstrument(listens, session="one") as scope:
        assert scope.begin() == {"ok": True}
        scope.block(1, 110, drive[110:200], displacement[110:200])  # ten samples were lost meanwhile
        status = played(server, bench, 200)
        assert status["instrument"]["is_connected"] and status["instrument"]["lost_samples"] == 10
    server.until(bench["id"], lambda one: not one["instrument"]["is_connected"])
    with FakeInstrument(listens) as scope:  # another session: its numbers and its clock have begun again
        scope.begin()
        scope.block(0, 0, drive[200:300], displacement[200:300])
        status = played(server, bench, 301)
    assert status["instrument"]["breaks"] == 1 and status["tick"] == 301
    told = [one["text"] for one in server.http.get(f"/api/v1/benches/{bench['id']}/events").json()["events"]]
    assert sum("is gone" in one for one in told) >= 2 and sum("is back" in one for one in told) == 2


def test_lost_late_and_doubled_blocks_are_counted_and_missing_samples_are_lost(
    server: Live, listens: str, measured: tuple[Any, Any]
) -> None:
    drive, displacement = measured
    with FakeInstrument(listens) as scope:
        scope.begin()
        bench = opened(server)
        for number in (0, 2, 1, 2, 3, 6):  # 1 comes late, 2 twice, 4 and 5 never
            part = slice(10 * number, 10 * number + 10)
            scope.block(number, part.start, drive[part], displacement[part])
        status = played(server, bench, 70)["instrument"]
    counts = {name: status[name] for name in ("blocks", "lost_blocks", "late_blocks", "doubled_blocks", "lost_samples")}
    assert counts == {"blocks": 4, "lost_blocks": 3, "late_blocks": 1, "doubled_blocks": 1, "lost_samples": 30}
    kept, there = displacement[:70].copy(), drive[:70].copy()
    for first, end in ((10, 20), (40, 60)):
        kept[first:end], there[first:end] = np.nan, drive[first - 1]
    record = MeasuredRecord(50.0, there, kept)
    RecordFolder().keep(record)
    whole = run(Scenario.load({**on_record(get("ch5-seven-step"), record), "samples": 70}))
    assert digest(server, bench)["digest"] == whole.digest


def test_units_and_pairing_of_the_header_hold(server: Live, listens: str, measured: tuple[Any, Any]) -> None:
    drive, displacement = measured
    with FakeInstrument(listens, units=["mV", "nm"], pairing="last", names=["CH1", "CH2"]) as scope:
        scope.begin()
        bench = opened(server)
        scope.block(0, 0, 1e3 * drive[:60], 1e3 * displacement[:60])
        scope.block(1, 60, 1e3 * drive[60:120], 1e3 * displacement[60:120])
        status = played(server, bench, 119)["instrument"]
        assert status["samples"] == 119 and status["names"] == ["CH1", "CH2"]
    found = RecordFolder().get(status["record"])
    assert found is not None
    voltage, motion, _ = found.stretch(0, 119)
    assert np.allclose(voltage, drive[1:120]) and np.allclose(motion, displacement[:119])


HEADER = {"version": 1, "source": "scope", "rate_khz": 50.0}


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        (b"GET / HTTP/1.1\r\n", "header: is no JSON"),
        (b"\xff\xfe\x00\n", "header: is no JSON"),
        (b"[" * 4000 + b"\n", "header: is no JSON"),
        (b"x" * 70_000 + b"\n", "longer than 4096 bytes"),
        (b"[1]\n", "header: must be an object"),
        (json.dumps({**HEADER, "version": 2}).encode() + b"\n", "header.version: must be one of 1"),
        (json.dumps({**HEADER, "source": "../x"}).encode() + b"\n", "header.source"),
        (json.dumps({**HEADER, "units": ["A", "um"]}).encode() + b"\n", "header.units.0"),
        (b'{"version": 1, "source": "scope", "rate_khz": NaN}\n', "header.rate_khz"),
        (json.dumps({**HEADER, "address": "x"}).encode() + b"\n", "header.address: unknown field"),
    ],
)
def test_a_wrong_header_is_refused_in_one_line(line: bytes, complaint: str, server: Live, listens: str) -> None:
    with FakeInstrument(listens) as scope:
        scope.send(line)
        answer = scope.answer()
        assert complaint in answer["error"], answer
        assert scope.answer() == {}


def test_a_wrong_block_is_refused_and_the_record_keeps_its_samples(
    server: Live, listens: str, measured: tuple[Any, Any]
) -> None:
    drive, displacement = measured
    bench, tick = None, 0
    for wrong, complaint in (
        (struct.pack("<QqI", 1, 10**6, 2**31 - 1), "block 1: has 2147483647 samples; allowed: 1 to 65536"),
        (struct.pack("<QqI", 1, 10**6, 0), "block 1: has 0 samples"),
        (struct.pack("<QqIdd", 1, 1_000_000, 1, float("nan"), 0.0), "the drive is no finite number at sample 0"),
        (struct.pack("<QqIdd", 1, 0, 1, 0.0, 0.0), "before the end of the block before it"),
    ):
        with FakeInstrument(listens) as scope:
            assert scope.begin() == {"ok": True}
            bench = bench or opened(server)
            scope.block(0, 0, drive[:50], displacement[:50])
            tick += 50 + (tick > 0)  # a break between two sessions is one lost sample
            played(server, bench, tick)
            scope.send(wrong)
            answer = scope.answer()
            assert complaint in answer["error"], answer
            server.wait(lambda: not source(server)["is_connected"])
            assert complaint in source(server)["refused"]
    assert bench is not None
    status = server.get(bench["id"])
    assert status["tick"] == tick == status["instrument"]["samples"] and status["state"] == "running"


def test_half_a_block_and_a_slow_one_are_refused(server: Live, listens: str, measured: tuple[Any, Any]) -> None:
    drive, displacement = measured
    with FakeInstrument(listens) as scope:
        scope.begin()
        bench = opened(server)
        scope.block(0, 0, drive[:50], displacement[:50])
        played(server, bench, 50)
        scope.block(1, 50, drive[50:60], displacement[50:60], count=20)
        scope.socket.shutdown(socket.SHUT_WR)
        assert "ended in block 1, after 160 bytes" in scope.answer()["error"]
    with FakeInstrument(listens) as scope:
        server.wait(lambda: not source(server)["is_connected"])
        scope.begin()
        scope.block(1, 50, drive[50:60], displacement[50:60], count=20)
        server.wait(lambda: _waits(server))
        server.advance(seconds=5.0)
        assert source(server)["is_connected"]
        server.advance(seconds=6.0)
        assert "block 1 did not come whole within 10 s" in scope.answer()["error"]
    assert server.get(bench["id"])["instrument"]["samples"] == 50


def _waits(live: Live) -> bool:
    readers = list(live.service.instruments._readers)
    return any(one._awaited == "block 1" for one in readers)


def test_of_two_senders_the_second_is_refused_until_the_first_is_silent(
    server: Live, listens: str, measured: tuple[Any, Any]
) -> None:
    drive, displacement = measured
    with FakeInstrument(listens) as first:
        first.begin()
        bench = opened(server)
        with FakeInstrument(listens) as second:
            assert "scope sends already, from 127.0.0.1" in second.begin()["error"]
        first.block(0, 0, drive[:50], displacement[:50])
        played(server, bench, 50)
        server.advance(seconds=6.0)
        with FakeInstrument(listens) as third:
            assert third.begin() == {"ok": True}
            assert "taken its place" in first.answer()["error"]
            third.block(0, 0, drive[50:90], displacement[50:90])
            assert played(server, bench, 91)["instrument"]["is_connected"]


def test_a_record_that_is_too_long_ends_and_the_board_trips_at_its_end(server: Live, listens: str) -> None:
    with FakeInstrument(listens) as scope:
        scope.begin()
        bench = opened(server)
        still = np.zeros(15_000)
        scope.block(0, 0, still, still)
        played(server, bench, 15_000)
        scope.block(1, 15_000, still, still)
        server.until(bench["id"], lambda one: one["state"] == "tripped")
        status = server.get(bench["id"])
        assert status["trip"]["reason"] == "the record has ended" and status["tick"] == 15_000
        assert source(server)["is_connected"] and source(server)["records"] == 0
    told = [one["text"] for one in server.http.get(f"/api/v1/benches/{bench['id']}/events").json()["events"]]
    assert any("would have 30000 samples; at most 20000" in one for one in told)


def test_a_bench_that_begins_again_plays_its_record_and_goes_on_live(
    server: Live, listens: str, measured: tuple[Any, Any]
) -> None:
    drive, displacement = measured
    with FakeInstrument(listens) as scope:
        scope.begin()
        bench = opened(server)
        scope.block(0, 0, drive[:200], displacement[:200])
        played(server, bench, 200)
        before = digest(server, bench)
        assert server.command(bench["id"], "reset").status_code == 200
        assert server.command(bench["id"], "start").status_code in (200, 409)
        played(server, bench, 200)
        assert digest(server, bench) == before
        scope.block(1, 200, drive[200:260], displacement[200:260])
        assert played(server, bench, 260)["state"] == "running"


def test_an_instrument_plays_with_a_device_that_a_record_calibrated(server: Live, listens: str) -> None:
    one = draw(1, samples=2000)
    rows = zip(one.drive.tolist(), one.displacement.tolist(), strict=True)
    content = "\n".join(["drive,displacement", *(f"{u!r},{y!r}" for u, y in rows)])
    made = server.http.post("/api/v1/records", content=content, params={"name": "a.csv", "rate_khz": 50}).json()
    body = {"record": made["id"], "end": 2000, "name": "die 7"}
    device = server.http.post("/api/v1/measured-devices", json=body).json()
    with FakeInstrument(listens) as scope:
        scope.begin()
        values = opened(server, device=device["id"], set={"sensor.noise_um": 0.2})["parameters"]
    assert values["device"]["mass_kg"] == device["values"]["device.mass_kg"]
    assert values["plant"]["delay_samples"] == device["values"]["plant.delay_samples"]
    assert values["sensors"]["recorded"]["noise_um"] == 0.2
    unknown = server.http.post("/api/v1/instruments/scope/benches", json={"device": "0" * 30})
    assert unknown.status_code == 404 and "measured device" in unknown.json()["error"]["message"]


STOPPED = "the record of instrument scope ends at sample 300: the server was stopped; it is kept as "
CUT_OFF = "the record of instrument scope ends at sample 300: its server ended meanwhile; it is kept as "


def told(live: Live, bench: str) -> list[str]:
    return [one["text"] for one in live.http.get(f"/api/v1/benches/{bench}/events").json()["events"]]


@pytest.mark.parametrize(("is_killed", "line"), [(False, STOPPED), (True, CUT_OFF)])
def test_after_a_restart_a_bench_says_once_that_its_record_has_ended_and_where_it_is_kept(
    is_killed: bool, line: str, tmp_path: Path, measured: tuple[Any, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    drive, displacement = measured
    if is_killed:  # the file does not say why it ends
        monkeypatch.setattr(Source, "end", lambda self, record, why: live._growing.pop(record.key))
    with serving(tmp_path, instrument_port=0) as first:
        with FakeInstrument(first.http.get("/api/v1/instruments").json()["listens"]) as scope:
            scope.begin()
            bench = opened(first)["id"]
            scope.block(0, 0, drive[:300], displacement[:300])
            played(first, {"id": bench}, 300)
            before = digest(first, {"id": bench})
            first.advance(seconds=1.0)  # checkpoints are less than a second old
    for _ in range(2):
        with serving(tmp_path, instrument_port=0) as second:
            second.until(bench, lambda one: one["state"] == "tripped")
            status = second.get(bench)
            assert status["tick"] == 300 and digest(second, {"id": bench}) == before
            instrument = status["instrument"]
            assert not instrument["is_growing"] and instrument["ended"].startswith(line)
            assert instrument["blocks"] == (0 if is_killed else 1)  # of a crash the counts are not known
            assert [one for one in told(second, bench) if one == instrument["ended"]] == [instrument["ended"]]
            kept = tmp_path / "records" / f"{instrument['record']}.live"
            made = second.http.post("/api/v1/records", content=kept.read_bytes(), params={"name": kept.name}).json()
            assert made["samples"] == 300  # the page calibrates it as any other record


def test_a_bench_whose_record_is_lost_says_so_after_a_restart(tmp_path: Path, measured: tuple[Any, Any]) -> None:
    drive, displacement = measured
    with serving(tmp_path, instrument_port=0) as first:
        with FakeInstrument(first.http.get("/api/v1/instruments").json()["listens"]) as scope:
            scope.begin()
            bench = opened(first)
            scope.block(0, 0, drive[:300], displacement[:300])
            played(first, bench, 300)
            first.advance(seconds=1.0)
    (tmp_path / "records" / f"{bench['instrument']['record']}.live").unlink()
    with serving(tmp_path) as second:
        for answer in (
            second.http.get(f"/api/v1/benches/{bench['id']}"),
            second.http.post(f"/api/v1/benches/{bench['id']}/reopen"),
        ):
            assert answer.status_code == 404
            assert "could not come back after a restart: plant.record: no record" in answer.json()["error"]["hint"]


def test_a_record_without_a_bench_grows_no_longer(server: Live, listens: str) -> None:
    with FakeInstrument(listens) as scope:
        scope.begin()
        bench = opened(server)
        assert source(server)["records"] == 1
        server.http.delete(f"/api/v1/benches/{bench['id']}")
        server.advance(seconds=1.5)
        assert source(server)["records"] == 0


def test_nobody_connects_unless_a_port_is_set_and_the_address_is_allowed(shared: Live, tmp_path: Path) -> None:
    assert shared.http.get("/api/v1/instruments").json() == {"listens": "", "instruments": []}
    refused = shared.http.post("/api/v1/instruments/scope/benches", json={})
    assert refused.status_code == 404 and "instrument_port" in refused.json()["error"]["hint"]
    with serving(tmp_path, instrument_port=0, instrument_peers=["192.0.2.0/24"]) as live:
        with FakeInstrument(live.http.get("/api/v1/instruments").json()["listens"]) as scope:
            assert "127.0.0.1 may not connect" in scope.answer()["error"]


def test_a_scenario_that_has_no_place_for_a_record_is_refused_and_no_file_stays(server: Live, listens: str) -> None:
    with FakeInstrument(listens) as scope:
        scope.begin()
        before = set(RecordFolder().path.glob("*.live"))
        for scenario, field in (("gyro-open-loop", "scenario"), ("no-such", "")):
            answer = server.http.post("/api/v1/instruments/scope/benches", json={"scenario": scenario})
            assert answer.status_code in (404, 422) and field in answer.json()["error"]["field"], answer.text
        wrong = server.http.post("/api/v1/instruments/scope/benches", json={"set": {"sample_rate_khz": 10.0}})
        assert wrong.status_code == 422 and "sample_rate_khz" in wrong.json()["error"]["field"]
        assert set(RecordFolder().path.glob("*.live")) == before

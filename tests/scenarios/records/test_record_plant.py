"""A record as the plant: the bits of the bank, slices, labels, refusals."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from core.board.board import Board
from core.board.commands import parse_command
from core.errors import InputError
from core.measured_record import MeasuredRecord
from scenarios.library import get
from scenarios.records.bench import on_record
from scenarios.records.shelf import RecordFolder
from scenarios.run import RunResult, run
from scenarios.schema import Scenario


def bench(record: MeasuredRecord, folder: RecordFolder, **more: Any) -> dict[str, Any]:
    folder.keep(record)
    return {**on_record(get("ch5-seven-step"), record), **more}


def board(document: dict[str, Any], *, compiled: bool = True) -> Board:
    return Board(Scenario.load(document).spec, compiled=compiled)


def test_a_trace_of_the_bench_gives_the_bits_of_its_own_bank(
    seven: RunResult, own: MeasuredRecord, folder: RecordFolder
) -> None:
    again = run(Scenario.load(bench(own, folder)), taps=True)
    for signal in ("drive.voltage", "sensor.displacement", "kalman.winner", "kalman.truth", "kalman.least_nis"):
        assert np.array_equal(again.signal(signal), seven.signal(signal)), signal
    for name in ("healthy", "m+5", "m+10", "k+5", "k+10", "b+30"):
        one = f"kalman.probability.{name}"
        assert np.array_equal(again.signal(one).view(np.int64), seven.signal(one).view(np.int64))
    figure = "diagnosis.kalman.correct_fraction"
    assert again.metrics[figure] == seven.metrics[figure]
    assert again.samples == own.samples and again.trip is None
    assert not any(name.startswith("control.") for name in again.metrics)


def test_the_narrator_judges_a_verdict_only_where_labels_tell_the_truth(
    own: MeasuredRecord, folder: RecordFolder
) -> None:
    bare = MeasuredRecord(own.rate_khz, own.drive, own.displacement)
    labelled, unlabelled = (run(Scenario.load(bench(one, folder)), narrate=True).narration for one in (own, bare))
    assert len(labelled) == len(unlabelled) > 3
    assert all("Correct" in said.text or "Wrong" in said.text for said in labelled)
    assert not any("Correct" in said.text or "Wrong" in said.text for said in unlabelled)


@pytest.mark.parametrize("slices", [(1,), (7, 64), (512,)])
def test_slices_plain_steps_and_copies_have_one_digest(
    slices: tuple[int, ...], own: MeasuredRecord, folder: RecordFolder
) -> None:
    document = bench(own, folder)
    whole = board(document)
    while whole.tick < 600:
        whole.advance(600 - whole.tick)
    cut = board(document, compiled=len(slices) > 1)
    turn = 0
    while cut.tick < 600:
        cut.advance(min(slices[turn % len(slices)], 600 - cut.tick))
        turn += 1
        if turn == 3:
            cut = Board.restore(cut.checkpoint())
    assert cut.digest() == whole.digest()


def test_a_record_without_labels_has_verdicts_and_no_score(own: MeasuredRecord, folder: RecordFolder) -> None:
    plain = MeasuredRecord(50.0, own.drive.copy(), own.displacement.copy())
    found = run(Scenario.load(bench(plain, folder)), taps=True)
    assert found.board.scores() == {} and not any(name.endswith("correct_fraction") for name in found.metrics)
    assert np.isnan(found.signal("kalman.correct_fraction")).all()
    assert found.signal("kalman.winner").max() > 0


def test_lost_samples_are_held_and_never_invented(own: MeasuredRecord, folder: RecordFolder) -> None:
    y = own.displacement.copy()
    y[100:103] = np.nan
    y[700::9] = np.nan
    found = run(Scenario.load(bench(MeasuredRecord(50.0, own.drive.copy(), y), folder)))
    assert found.trip is None and found.samples == own.samples
    seen = found.signal("sensor.displacement")
    assert (seen[100:103] == y[99]).all() and np.array_equal(seen[103:200], y[103:200])


KINDS = ("mmae", "imm", "cusum", "lock_in", "reseed", "consistency")


def test_banks_are_as_right_with_lost_samples_as_without(own: MeasuredRecord, folder: RecordFolder) -> None:
    """A held sample is no measurement: banks predict there and weigh nothing."""
    y = own.displacement.copy()
    y[np.random.default_rng(5).random(len(y)) < 0.08] = np.nan
    y[5000:5040] = np.nan
    hypotheses = get("ch5-seven-step").document["diagnosers"]["kalman"]["hypotheses"]
    banks = {kind: {"kind": kind, "hypotheses": hypotheses} for kind in KINDS}
    lossy = MeasuredRecord(50.0, own.drive.copy(), y, own.label, own.hypotheses)
    found, whole = (run(Scenario.load(bench(one, folder, diagnosers=banks))).metrics for one in (lossy, own))
    for kind in KINDS:
        name = f"diagnosis.{kind}.correct_fraction"
        assert whole[name] > 0.8
        assert found[name] == pytest.approx(whole[name], abs=0.02), kind


def test_offset_and_delay_of_a_calibration_are_taken_out(own: MeasuredRecord, folder: RecordFolder) -> None:
    document = bench(own, folder, samples=50)
    document["plant"] = {**document["plant"], "offset_um": 0.25, "delay_samples": 2.5}
    found = run(Scenario.load(document))
    drive = own.drive
    assert found.signal("sensor.displacement")[20] == own.displacement[20] - 0.25
    expected = (9.0 * (drive[18] + drive[17]) - drive[19] - drive[16]) / 16.0
    assert found.signal("drive.voltage")[20] == pytest.approx(expected, abs=1e-12)


def test_the_board_trips_at_the_end_of_the_record(own: MeasuredRecord, folder: RecordFolder) -> None:
    short = MeasuredRecord(50.0, own.drive[:30].copy(), own.displacement[:30].copy())
    live = board(bench(short, folder))
    assert live.advance(100).count == 30 and live.trip is None
    assert live.advance(100).count == 0 and live.trip is not None and live.trip.reason == "the record has ended"


@pytest.mark.parametrize(
    ("change", "field", "text"),
    [
        ({"sensor": {"kind": "ideal"}}, "sensor.kind", "cannot act on a record"),
        ({"sample_rate_khz": 77.0}, "sample_rate_khz", "50.0 samples for each ms"),
        ({"plant": {"model": "record"}}, "plant.record", "no record"),
        ({"samples": 9001}, "samples", "the record has 9000"),
        ({"events": [{"fault": "added_mass", "severity": 0.05, "at_sample": 10}]}, "events.0.fault", "takes no faults"),
        ({"plant": {"model": "linear"}}, "sensor.kind", "is for record only"),
    ],
)
def test_what_cannot_be_on_a_record_is_refused(
    change: dict[str, Any], field: str, text: str, own: MeasuredRecord, folder: RecordFolder
) -> None:
    with pytest.raises(InputError, match=text) as refused:
        Scenario.load(bench(own, folder, **change))
    assert refused.value.field == field


def test_no_fault_reaches_a_live_record(own: MeasuredRecord, folder: RecordFolder) -> None:
    live = board(bench(own, folder))
    live.advance(10)
    with pytest.raises(InputError, match="takes no faults"):
        live.apply(parse_command({"fault": "added_mass", "severity": 0.05}))
    assert live.advance(10).count == 10


def test_a_law_in_shadow_drives_nothing(own: MeasuredRecord, folder: RecordFolder) -> None:
    found = run(Scenario.load(bench(own, folder, controller={"kind": "pid"}, samples=500)), everything=True)
    assert np.array_equal(found.signal("drive.voltage"), own.drive[:500]) and found.trip is None


@pytest.mark.parametrize("spoil", [lambda bits: b"PK" + bits[2:400], lambda bits: bits[:-9], lambda _: b"no record"])
def test_a_damaged_file_of_the_shelf_is_no_record(spoil: Any, own: MeasuredRecord, folder: RecordFolder) -> None:
    document = bench(own, folder)
    (file,) = folder.path.glob("*.npz")
    file.write_bytes(spoil(file.read_bytes()))
    with pytest.raises(InputError, match="no record"):
        Scenario.load(document)

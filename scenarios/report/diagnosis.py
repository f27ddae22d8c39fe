"""The report of a diagnosed record: one HTML file that needs nothing else."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from core.block import FloatArray
from core.format import format_count, format_figure, format_number, format_short, unit_text
from core.measured_record import UNLABELLED
from scenarios.measure.blocks import stretches
from scenarios.metric_name import metric_scale
from scenarios.records.diagnosis import UNEXPLAINED, UNSURE, RecordDiagnosis
from scenarios.report.axis import Axis
from scenarios.report.html import page
from scenarios.report.palette import LineStyle, hypothesis
from scenarios.report.rows import ReportRow, RowChart, paint_rows
from scenarios.report.svg import AreaRow, Chart, EventMark, Series, thin

MOST_ROWS = 200
NUMBERS = (
    ("mass", "mass", "of nominal"),
    ("damping", "damping", "of nominal"),
    ("stiffness", "stiffness", "of nominal"),
    ("offset_um", "offset", unit_text("um")),
    ("delay_samples", "delay", "samples"),
)
CHECKS = {
    "clipped": "samples at an extreme value, share",
    "delay_change": "change of the delay, samples",
    "residual_ratio": "error over the error of the fitted half",
    "correlation": "correlation of errors",
    "pulled": "change of a number by a hidden effect, over its limit",
}
OTHER = {UNEXPLAINED: LineStyle(0), UNSURE: LineStyle(7)}
"""Looks of verdicts that are no hypothesis."""


def diagnosis_report(found: RecordDiagnosis, file: str, columns: Mapping[str, str], notes: Sequence[str]) -> str:
    """Return the report of a diagnosis.

    Parameters
    ----------
    found : RecordDiagnosis
        The diagnosis, or the refusal.
    file : str
        Name of the file.
    columns : mapping
        The column of each part of the record.
    notes : sequence of str
        Sentences about the reading.
    """
    record, calibration = found.record, found.calibration
    parts = ", ".join(f"{part} from column {column}" for part, column in columns.items())
    rate = format_short(record.rate_khz, "kHz")
    last = calibration.first + calibration.samples
    figures = found.result.metrics if found.result is not None and record.label is not None else {}
    return page(
        "diagnosis.html",
        f"Diagnosis of {file}",
        outcome=found.outcome,
        sentence=found.sentence,
        facts=f"{format_count(record.samples, 'sample')} at {rate}; {parts}.",
        notes=notes,
        banks=[_bank(found, name) for name in found.verdicts],
        charts=_record(found),
        fitted=f"Samples {calibration.first} to {last} were taken for healthy: half of them were fitted, half test the "
        "fit. Voltage and displacement tell only ratios to the force, which stays nominal.",
        ratios=paint_rows(_ratios(found)),
        numbers=[*map(list, _numbers(found))],
        checks=[
            [CHECKS.get(one.name, one.name), one.value, one.limit, "holds" if one.ok else "does not hold"]
            for one in calibration.checks
        ],
        refusal=found.refusal and found.sentence,
        scores=[[metric_scale(name, [value]).title, format_figure(name, value, 4)] for name, value in figures.items()],
    )


def _numbers(found: RecordDiagnosis) -> list[tuple[Any, ...]]:
    rows: list[tuple[Any, ...]] = []
    for name, said, unit in NUMBERS:
        one = getattr(found.calibration, name)
        rows.append((said, one.value, *one.interval, unit))
    quantum, noise = found.calibration.quantum_um, found.calibration.noise_um
    rows.append(("noise of a sample", format_short(noise, "um"), "", "", ""))
    rows.append(("step of the converter", format_short(quantum, "um") if quantum else "none seen", "", "", ""))
    return rows


def _ratios(found: RecordDiagnosis) -> RowChart:
    """Show the three ratios with their 95 % intervals."""
    rows = []
    for name, said, _ in NUMBERS[:3]:
        one = getattr(found.calibration, name)
        rows.append(ReportRow(said, one.value, one.interval[1] - one.value))
    ends = [end for row in rows for end in (row.value - row.spread, row.value + row.spread)]
    low, high = min(ends), max(ends)
    air = 0.06 * (high - low) or 0.05
    return RowChart("Over nominal, with 95 % intervals", Axis("of nominal", "", (low - air, high + air)), rows)


def _time(found: RecordDiagnosis) -> Axis:
    return Axis("time", "ms", (0.0, found.record.samples / found.record.rate_khz))


def _record(found: RecordDiagnosis) -> list[Chart]:
    """Return displacement and voltage; lost samples are left out."""
    record, calibration = found.record, found.calibration
    ends = (calibration.first, calibration.first + calibration.samples)
    said = ("the healthy stretch begins", "the healthy stretch ends")
    marks = [EventMark(end / record.rate_khz, text) for end, text in zip(ends, said, strict=True)]
    columns = (
        ("Displacement", "um", 3, record.displacement),
        ("Voltage", "V", 5, record.drive),
    )
    return [
        Chart(title, _time(found), Axis("", unit), [_line(title, found, values, LineStyle(slot))], marks)
        for title, unit, slot, values in columns
    ]


def _line(said: str, found: RecordDiagnosis, values: FloatArray, look: LineStyle) -> Series:
    known = np.flatnonzero(np.isfinite(values))
    places, shown = thin(np.asarray, values[known])
    return Series(said, (known[places] / found.record.rate_khz).tolist(), shown, look=look)


def _bank(found: RecordDiagnosis, name: str) -> dict[str, Any]:
    """Return the verdicts of a bank over time, with the probability of each hypothesis."""
    assert found.result is not None
    verdicts, result = found.verdicts[name], found.result
    hypotheses = [one.name.split(".probability.")[1] for one in result.kept if one.name.startswith(f"{name}.prob")]
    looks = {word: hypothesis(number) for number, word in enumerate(hypotheses)} | OTHER
    shares = found.shares[name]
    lanes = [AreaRow("label", _labels(found, looks))] if found.record.label is not None else []
    lanes += [AreaRow(word, _areas(found, name, word, look)) for word, look in looks.items() if word in shares]
    lines = [
        _line(word, found, np.asarray(result.signal(f"{name}.probability.{word}")), looks[word]) for word in hypotheses
    ]
    share = shares.get(UNEXPLAINED, 0.0)
    return {
        "name": name,
        "unexplained": f"No hypothesis explains {format_number(100.0 * share, 1)} % of the record." if share else "",
        "charts": [
            Chart("Verdict over time", _time(found), lanes=lanes),
            Chart("Confidence: probability of each hypothesis", _time(found), Axis("", "", (0.0, 1.0)), lines),
        ],
        "count": len(verdicts),
        "rows": [[one.first, one.end, one.verdict, format_number(one.probability, 3)] for one in verdicts[:MOST_ROWS]],
    }


def _areas(found: RecordDiagnosis, name: str, word: str, look: LineStyle) -> list[tuple[float, float, LineStyle, bool]]:
    rate = found.record.rate_khz
    return [(one.first / rate, one.end / rate, look, False) for one in found.verdicts[name] if one.verdict == word]


def _labels(found: RecordDiagnosis, looks: Mapping[str, LineStyle]) -> list[tuple[float, float, LineStyle, bool]]:
    """Return the labels of the file; a label that no bank knows looks like no hypothesis."""
    label, rate = found.record.label, found.record.rate_khz
    assert label is not None
    edges = pairwise([*stretches(label.astype(np.float64)), len(label)])
    return [
        (first / rate, end / rate, looks.get(found.record.hypotheses[label[first]], OTHER[UNSURE]), False)
        for first, end in edges
        if label[first] != UNLABELLED
    ]

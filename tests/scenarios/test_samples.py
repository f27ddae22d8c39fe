"""Runs of any length in bounded memory: figures, traces and reports, the same bits as in memory."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from scenarios import samples
from scenarios.campaign.outcome import outcome_of
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.report.figure import figure
from scenarios.report.run import run_report
from scenarios.report.traces import TraceFile
from scenarios.run import run

SHORT = 200_000
MOST_MB = 30
"""Limit of the growth of memory; the outputs of the longer run are 120 MB, the outputs of its figures 80 MB."""
PEAK = """
import json, re, sys
from scenarios import samples
samples.IN_MEMORY = 100_000
def peak():  # not ru_maxrss, which begins with the size of the process that started this one
    return int(re.search(r"VmHWM:\\s+(\\d+)", open("/proc/self/status").read())[1]) / 1000
"""
BY = {
    "figures": """
from scenarios.campaign.outcome import outcome
from scenarios.edit import with_values
from scenarios.library import get
def carry_out(ticks):
    assert outcome(with_values(get("ch5-seven-step"), {"samples": ticks}), 1).ticks == ticks
""",
    "command line": """
from server.cli import main as cli
def carry_out(ticks):
    sys.argv = ["combbench", "run", "ch5-seven-step", "--set", f"samples={ticks}", "--out", sys.argv[-1]]
    try:
        cli.main()
    except SystemExit as end:
        assert end.code in (0, 1)
""",
    "server": """
from scenarios.edit import with_values
from scenarios.library import get
from server.runs.worker import Keep
def carry_out(ticks):
    document = with_values(get("ch5-seven-step"), {"samples": ticks}).document
    Keep(sys.argv[-1], 10**10)(json.loads(json.dumps(document, default=str)), 1, [[]])
""",
}


@pytest.mark.long
@pytest.mark.parametrize("by", BY)
def test_memory_does_not_grow_with_the_length_of_a_run(by: str, tmp_path: Path) -> None:
    """The largest resident size of a process of its own, after a run and after one four times as long."""
    program = f"{PEAK}{BY[by]}\nfor ticks in ({SHORT}, {4 * SHORT}):\n    carry_out(ticks); print('MB', peak())\n"
    asked = [sys.executable, "-c", program, str(tmp_path)]
    said = subprocess.run(asked, capture_output=True, text=True, check=True).stdout
    short, long = (float(text) for text in re.findall(r"^MB (\S+)$", said, re.M))
    assert long - short < MOST_MB


@pytest.mark.parametrize("name", ["ch5-seven-step", "gyro-adaptive", "ch1-shock"])
def test_a_run_in_a_file_has_the_bits_of_one_in_memory(name: str, monkeypatch: Any) -> None:
    scenario = get(name)
    inside = run(scenario)
    monkeypatch.setattr(samples, "IN_MEMORY", 1000)
    outside = run(scenario)
    assert not isinstance(inside.signal("drive.voltage" if "gyro" not in name else "plant.x"), np.memmap)
    assert all(isinstance(column, np.memmap) for column in outside.trace.values())
    assert outside.metrics == inside.metrics and outside.digest == inside.digest
    unlike = {"elapsed_s"}
    assert outcome_of(outside).model_dump(exclude=unlike) == outcome_of(inside).model_dump(exclude=unlike)
    for signal in inside.kept:
        assert np.array_equal(outside.signal(signal.name), inside.signal(signal.name), equal_nan=True)
    assert figure(outside) == figure(inside)
    reports = [run_report(found, inside.summary()) for found in (outside, inside)]
    assert len({re.sub(r"\d{4}-\d\d-\d\d \d\d:\d\d UTC", "", text) for text in reports}) == 1


def test_a_trace_is_there_whole_or_not_at_all(tmp_path: Path) -> None:
    scenario = with_values(get("ch5-seven-step"), {"samples": 40_000})
    path = tmp_path / "new" / "run.parquet"

    def stop(tick: int) -> None:
        if tick > 35_000:
            assert [one.name for one in path.parent.iterdir()] == ["run.parquet.part"]
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), TraceFile(path, scenario.document) as trace:
        run(scenario, taps=True, trace=trace, on_tick=stop)
    assert not list(path.parent.iterdir())
    with TraceFile(path, scenario.document) as trace:
        run(scenario, taps=True, trace=trace)
    table, expected = pq.read_table(path), run(scenario, taps=True)
    assert table.column_names[2:] == [signal.name for signal in expected.kept]
    assert table["tick"].to_pylist() == list(range(40_000))
    for name, values in expected.trace.items():
        assert np.array_equal(table[name].to_numpy(), values, equal_nan=True), name

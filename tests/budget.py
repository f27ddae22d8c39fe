"""The time each test may take, in processor time of a loop that is timed in the same process.

A test above `MOST` units fails, unless it belongs to the long suite or `ALLOWED` names it with a reason; one above
`MANY` is listed at the end. Processor time of a busy machine is longer too, so the loop is timed again before a test is
listed or fails. A unit is about a second of a machine of 2024.
"""

from __future__ import annotations

import resource
from collections.abc import Iterator
from functools import cache

import pytest

MANY, MOST = 2.0, 6.0
LOOPS = 1_500_000
PARTS = 20
"""Parts of a unit that are timed: the loop takes a twentieth of it."""

ALLOWED: dict[str, str] = {
    "tests/repo/test_codegen.py::test_recorded_answers_are_current": "It records all answers that views are tested on.",
    "tests/scenarios/in_a_file/test_same_bits.py::test_slow_blocks": "It compiles a bench of its own to WebAssembly.",
    "tests/server/test_folder.py::test_rest_and_command_line_give_one_file": "It compiles two benches to WebAssembly.",
    "tests/server/test_fuzz.py::test_no_request_brings_a_failure": "It asks at every door of the OpenAPI document.",
}
"""Tests of the short suite that may take longer, by the beginning of their names, and the reason."""

USED = pytest.StashKey[float]()


def used_s() -> float:
    """Return the processor time of this process and of its finished child processes, s."""
    parts = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(part.ru_utime + part.ru_stime for part in parts)


def unit_s() -> float:
    """Return how long a unit takes now, s: the shortest of three timings of the loop."""
    return PARTS * min(_loop_s() for _ in range(3))


@cache
def first_unit_s() -> float:
    """Return how long a unit took when this process needed it first, s."""
    return unit_s()


def units_of(seconds: float) -> float:
    """Return a processor time in units of now; a short one in units of the first timing."""
    units = seconds / first_unit_s()
    return units if units <= MANY else seconds / unit_s()


def _loop_s() -> float:
    before, total = used_s(), 0.0
    for number in range(LOOPS):
        total += number * 0.5
    return used_s() - before


def reason_of(name: str) -> str | None:
    """Return why a test may take long, if it may."""
    return next((reason for start, reason in ALLOWED.items() if name.startswith(start)), None)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Iterator[None]:
    """Fail a test that used more processor time than it may."""
    report: pytest.TestReport = yield
    used = item.stash.get(USED, 0.0) if call.when == "call" else 0.0
    if used > 0.5 * MANY and item.get_closest_marker("long") is None:  # half: a unit may be that short
        units = units_of(used)
        if units > MANY:
            report.user_properties.append(("units", f"{units:.1f}"))
        if units > MOST and report.passed and reason_of(item.nodeid) is None:
            report.outcome = "failed"
            report.longrepr = (
                f"{units:.1f} units of processor time, {MOST:g} are allowed: make it cheaper, mark it long, "
                "or name it in tests/budget.py with the reason"
            )
    return report


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    """Note the processor time of the body of a test; the time of fixtures is shared by many."""
    before = used_s()
    try:
        return (yield)
    finally:
        item.stash[USED] = used_s() - before


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """List the tests that took many units."""
    reports = [report for kind in ("passed", "failed") for report in terminalreporter.stats.get(kind, [])]
    measured = [(dict(report.user_properties).get("units"), report.nodeid) for report in reports]
    found = [(float(units), name) for units, name in measured if units]
    if found:
        terminalreporter.section(f"tests above {MANY:g} units of processor time")
        for units, name in sorted(found, reverse=True):
            terminalreporter.line(f"{units:6.1f}  {name}")

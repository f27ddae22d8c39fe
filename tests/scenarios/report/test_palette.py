"""Reports have the colours of the page, from one file."""

from __future__ import annotations

import json
import re
from pathlib import Path

from scenarios.library import get
from scenarios.report import palette
from scenarios.report.run import run_report
from scenarios.report.thumbnail import thumbnail
from scenarios.run import run

SHARED = json.loads((Path(__file__).parents[3] / "scenarios/report/palette.json").read_text())
LIGHT, ORDER = SHARED["colours"]["light"], SHARED["hypotheses"]


def test_lines_and_hypotheses_follow_the_rules_of_the_page():
    """Those that ``trace-style.test.ts`` and ``line-field.tsx`` have."""
    assert [palette.line(number).colour for number in range(8)] == [*LIGHT[1:], LIGHT[1]]
    assert palette.line(0).dash == "" and palette.line(1).dash == "8 4"
    assert [palette.hypothesis(number).colour for number in range(8)] == [LIGHT[slot] for slot in ORDER]
    assert palette.hypothesis(9) == palette.Look(LIGHT[ORDER[1]], "8 4")
    assert len({(palette.line(n).colour, palette.line(n).dash) for n in range(42)}) == 42
    assert all(len(colours) == len(LIGHT) for colours in SHARED["colours"].values())
    assert sorted(ORDER) == list(range(len(LIGHT)))


def test_a_hypothesis_has_its_colour_in_report_and_thumbnail():
    result = run(get("ch5-seven-step"), seed=1)
    names = result.board.scores()["kalman"].names
    report = run_report(result, result.summary())
    diagnoser = report[report.index("Diagnoser kalman") :]
    for number, name in enumerate(names):
        stroke = re.search(rf'stroke="(#\w+)"[^>]*><title>{re.escape(name)}</title>', diagnoser)
        assert stroke is not None and stroke[1] == palette.hypothesis(number).colour
    drawn = set(re.findall(r'<rect[^>]* fill="(#\w+)"', thumbnail(result)))
    assert drawn == {palette.hypothesis(number).colour for number in range(len(names))}
    plant = re.search(r'stroke="(#\w+)"[^>]*><title>plant.displacement</title>', report)
    assert plant is not None and plant[1] == LIGHT[SHARED["signals"]["plant.displacement"][0]]

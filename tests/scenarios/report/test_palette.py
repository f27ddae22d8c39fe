"""Reports have the colours of the page, from one file."""

from __future__ import annotations

import json
import re
from pathlib import Path

from scenarios.library import get
from scenarios.report import palette
from scenarios.report.figure import figure
from scenarios.report.run import run_report
from scenarios.report.svg import picture_file
from scenarios.run import run

SHARED = json.loads((Path(__file__).parents[3] / "scenarios/report/palette.json").read_text())
LIGHT, ORDER = SHARED["colours"]["light"], SHARED["hypotheses"]


def test_lines_and_hypotheses_follow_the_rules_of_the_page():
    """The rules in ``trace-style.test.ts`` and ``line-field.tsx``."""
    assert [palette.line(number).slot for number in range(8)] == [*range(1, 8), 1]
    assert palette.line(0).dash == "" and palette.line(1).dash == "8 4"
    assert [palette.hypothesis(number).slot for number in range(8)] == ORDER
    assert palette.hypothesis(9) == palette.LineStyle(ORDER[1], "8 4")
    assert len({(palette.line(n).slot, palette.line(n).dash) for n in range(42)}) == 42
    assert all(len(colours) == len(LIGHT) for colours in SHARED["colours"].values())
    assert sorted(ORDER) == list(range(len(LIGHT)))


def test_the_style_has_the_colours_of_both_schemes():
    light, dark = palette.style().split("@media (prefers-color-scheme: dark)")
    for part, colours in ((light, LIGHT), (dark, SHARED["colours"]["dark"])):
        assert re.findall(r"\.s\d \{ stroke: (#\w+) \}", part) == colours
        assert re.findall(r"\.f\d \{ fill: (#\w+) \}", part) == colours


def test_a_hypothesis_has_its_colour_in_report_and_figure():
    result = run(get("ch5-seven-step"), seed=1)
    names = result.board.scores()["kalman"].names
    report = run_report(result, result.summary())
    diagnoser = report[report.index('aria-label="Diagnoser kalman"') :]
    for number, name in enumerate(names):
        slot = re.search(rf'<g class="s(\d)"[^>]*><path[^>]*/><title>{re.escape(name)}</title>', diagnoser)
        assert slot is not None and int(slot[1]) == palette.hypothesis(number).slot
    drawn = set(re.findall(r'<rect[^>]* class="f(\d)"', picture_file(figure(result))))
    assert drawn == {str(palette.hypothesis(number).slot) for number in range(len(names))}
    plant = re.search(r'<g class="s(\d)"[^>]*><path[^>]*/><title>plant.displacement</title>', report)
    assert plant is not None and int(plant[1]) == SHARED["signals"]["plant.displacement"][0]

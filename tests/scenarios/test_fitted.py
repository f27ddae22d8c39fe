"""A number that one row of a figure names as fitted is fitted in the other rows of that figure too."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import pytest

from core.board.spec import Section, Spec
from scenarios.edit import with_values
from scenarios.expectation import Expectation
from scenarios.library import get, library
from scenarios.run import run
from scenarios.schema import Scenario
from tests.scenarios.test_library_rules import cited

FAMILIES = {"diagnosis": "diagnosers", "joined": "diagnosers", "identify": "identifiers"}
ANY = {
    ("ch3-ffrls-b10", "identify.doubting.settling_ms", "forgetting_rate"): (1.0, 1000.0),
    ("ch3-ffrls-b10", "identify.doubting.error_pct", "forgetting_rate"): (1.0, 1000.0),
    ("ch3-ffrls-b30", "identify.doubting.error_pct", "forgetting_rate"): (10.0, 300.0),
    ("ch3-indirect-mrac-b30", "control.rms_error_um", "covariance"): (1e-4, 1e4),
    ("ch3-mrac-heavy-model", "control.settling_ms", "adaptation_gain"): (0.01, 10.0),
    ("ch3-mrac-heavy-model", "control.tail_rms_error_um", "adaptation_gain"): (0.01, 10.0),
    ("ch3-mrac-heavy-model", "control.effort_ratio", "adaptation_gain"): (0.01, 10.0),
    ("ch3-mrac-mass-x10", "control.effort_ratio", "adaptation_gain"): (0.01, 1.0),
    ("ch4-augmentation", "control.tail_rms_error_um", "surface_slope"): (0.5, 8.0),
    ("ch4-augmentation", "twins.plain.control.tail_rms_error_um", "adaptation_gain"): (0.03, 0.3),
    ("ch4-augmentation", "twins.plain.control.tail_rms_error_um", "surface_slope"): (0.5, 8.0),
    ("ch4-bandwidth", "control.tail_rms_error_um", "surface_slope"): (0.5, 8.0),
    ("ch4-constant-reference", "twins.self_sliding.control.tail_rms_error_um", "adaptation_gain"): (0.01, 0.1),
    ("ch4-constant-reference", "twins.self_sliding.control.tail_rms_error_um", "surface_slope"): (0.5, 8.0),
    ("ch4-lcr-experiment", "control.tail_rms_error_um", "adaptation_gain"): (0.001, 0.1),
    ("ch4-lcr-experiment", "control.tail_rms_error_um", "surface_slope"): (0.5, 8.0),
    ("ch4-lcr-experiment", "control.effort_rms_v", "adaptation_gain"): (0.001, 0.1),
    ("ch4-lcr-experiment", "control.effort_rms_v", "surface_slope"): (0.5, 8.0),
    ("ch4-lcr-two-tone", "control.effort_rms_v", "adaptation_gain"): (0.001, 0.1),
    ("ch4-lcr-two-tone", "control.effort_rms_v", "surface_slope"): (0.5, 8.0),
    ("ch4-lcr-two-tone", "control.settling_ms", "surface_slope"): (0.5, 8.0),
    ("ch4-lcr-two-tone", "control.tail_rms_error_um", "surface_slope"): (0.5, 8.0),
    ("ch4-regulator", "control.overshoot_pct", "surface_slope"): (0.5, 8.0),
    ("ch4-regulator", "control.overshoot_pct", "layer_um"): (0.02, 0.2),
    ("ch4-regulator", "control.settling_ms", "adaptation_gain"): (0.3, 3.0),
    ("ch4-regulator", "control.settling_ms", "surface_slope"): (0.5, 8.0),
    ("ch4-regulator", "control.settling_ms", "layer_um"): (0.02, 0.2),
    ("ch4-regulator", "control.tail_rms_error_um", "adaptation_gain"): (0.3, 3.0),
    ("ch4-regulator", "control.tail_rms_error_um", "surface_slope"): (0.5, 8.0),
    ("ch4-regulator", "control.tail_rms_error_um", "layer_um"): (0.02, 0.2),
    ("ch4-regulator-mrac", "control.overshoot_pct", "adaptation_gain"): (0.3, 3.0),
    ("ch4-regulator-mrac", "control.settling_ms", "adaptation_gain"): (0.3, 3.0),
    ("ch4-regulator-vsmrc", "control.tail_rms_error_um", "reference_bound"): (0.5, 2.0),
    ("ch4-tracking", "control.first_peak_pct", "surface_slope"): (0.5, 8.0),
    ("ch4-tracking", "control.tail_rms_error_um", "surface_slope"): (0.5, 8.0),
    ("ch5-two-devices", "diagnosis.no_floor.delay_samples.2", "process_noise_v"): (0.1, 0.3),
    ("ch5-self-tuning-090", "diagnosis.self_tuning.delay_samples.3", "probability_floor"): (0.0, 0.01),
    ("ch5-self-tuning-098", "diagnosis.self_tuning.correct_fraction", "probability_floor"): (0.0, 0.01),
    ("ch5-self-tuning-098", "diagnosis.self_tuning.missed_steps", "probability_floor"): (0.0, 0.01),
}
"""Fields of rows that need no such number to agree with the text: they do at each of these values too."""
PRINTED = {
    ("ch5-two-devices", "diagnosis.no_floor.delay_samples.2", "probability_floor"): 0.0,  # 5.2.3.2.6 has none
}
"""Fields whose value is the one of the text."""


class Choice(NamedTuple):
    """A field of a block that a row names as fitted: where the row is from."""

    family: str
    field: str
    value: Any
    figures: set[str]
    chapter: str


def figures(scenario: Scenario, row: Expectation) -> set[str]:
    """Return the figures and tables that a row is about: of its source, its words, its marks."""
    texts = (scenario.head.source, row.published)
    said = {number for text in texts for kind, number in cited(text) if kind in ("figure", "table")}
    return said | {mark.figure for mark in scenario.head.printed if mark.figure and mark.metric == row.metric}


def blocks(scenario: Scenario, row: Expectation) -> Iterator[tuple[str, Section]]:
    """Yield the blocks that a metric is about, by their paths."""
    spec: Spec = scenario.spec
    metric, before = row.metric, ""
    if metric.startswith("twins."):
        _, twin, metric = metric.split(".", 2)
        spec, before = scenario.twins[twin], f"twins.{twin}."
    head, _, rest = metric.partition(".")
    family = FAMILIES.get(head, "")
    if head == "control":
        yield from ((f"{before}controller", spec.controllers[name]) for name in spec.driving.values())
    elif head == "compare":
        names = scenario.head.study["compare"] if scenario.head.study is not None else [rest.partition(".")[0]]
        yield from ((f"diagnosers.{name}", spec.diagnosers[name]) for name in names)
    elif family and (name := rest.partition(".")[0]) in (parts := getattr(spec, family)):
        yield f"{family if head == 'joined' else before + family}.{name}", parts[name]


def family(path: str) -> str:
    """Return the family of a block by its path."""
    return next(part for part in path.split(".") if part in ("controller", "diagnosers", "identifiers"))


def choices() -> list[Choice]:
    """Return the fields that rows of the library name as fitted in their blocks."""
    found = []
    for scenario in library():
        for row in scenario.head.expect:
            for path, section in blocks(scenario, row):
                for fitted in row.fitted:
                    field = fitted.rpartition(".")[2]
                    if f"{path}.{field}".endswith(fitted) and hasattr(section.params, field):
                        where = figures(scenario, row), scenario.id.partition("-")[0]
                        found.append(Choice(family(path), field, getattr(section.params, field), *where))
    return found


def untold() -> Iterator[tuple[str, str, str]]:
    """Yield the fields that rows do not name although a row of the figure does, or one of the chapter at this value."""
    chosen = choices()
    for scenario in library():
        for row in scenario.head.expect:
            if row.agreeing is None or not str(row.promised()).startswith("reproduced"):
                continue
            named = {path.rpartition(".")[2] for path in row.fitted}
            about, chapter = figures(scenario, row), scenario.id.partition("-")[0]
            for path, section in blocks(scenario, row):
                values = section.params.model_dump()
                for field in sorted(
                    {one.field for one in chosen if one.family == family(path)} & values.keys() - named
                ):
                    same = [one for one in chosen if (one.family, one.field) == (family(path), field)]
                    if any(one.figures & about or (one.chapter, one.value) == (chapter, values[field]) for one in same):
                        yield scenario.id, row.metric, field


def test_a_number_fitted_in_one_row_of_a_figure_is_fitted_in_all():
    found = set(untold())
    assert sorted(found - ANY.keys() - PRINTED.keys()) == []
    assert sorted((ANY.keys() | PRINTED.keys()) - found) == [], "needs no exception"


def test_a_field_that_is_as_printed_has_this_value():
    for (name, metric, field), value in PRINTED.items():
        (row,) = [one for one in get(name).head.expect if one.metric == metric]
        ((_, section),) = blocks(get(name), row)
        assert getattr(section.params, field) == value


@pytest.mark.parametrize("name", sorted({name for name, _, _ in ANY}))
def test_a_row_that_names_no_fitted_number_agrees_at_others_too(name: str):
    scenario, tried, wrong = get(name), dict[tuple[str, float], dict[str, float]](), []
    for row in scenario.head.expect:
        for path, section in blocks(scenario, row):
            for field in section.params.model_dump():
                for value in ANY.get((name, row.metric, field), ()):
                    place = f"{path}.{field}"
                    if (place, value) not in tried:
                        tried[place, value] = run(with_values(scenario, {place: value}), figures_only=True).metrics
                    measured = tried[place, value][row.metric]
                    if row.word(measured) == "not reproduced":
                        wrong.append(f"{row.metric} is {measured} at {field} = {value}")
    assert tried and wrong == []

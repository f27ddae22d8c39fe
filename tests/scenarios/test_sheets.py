"""The format of sheets, their formulas, and what answers are worth."""

from __future__ import annotations

import re
from importlib.resources import files

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.errors import InputError
from core.format import format_si
from scenarios import sheets
from scenarios.sheets.begin import begin
from scenarios.sheets.check import check
from scenarios.sheets.expression import evaluate
from scenarios.sheets.judge import judge
from scenarios.sheets.look import value_text, wanted_text
from scenarios.sheets.progress import Progress
from scenarios.sheets.quantity import parse_quantity
from scenarios.sheets.sheet import Limits, SheetQuestion

DESKTOP_ALONE = re.compile(
    r"(?i:space bar|keyboard|head of the page|header|tool ?bar|side ?bar|\btabs?\b|hover|right-click|mouse|dotted)"
    r"|(?:[Pp]ress|[Hh]old|[Tt]ype) [A-Z]\b|\b(?:Ctrl|Shift|Alt|Esc)\b|(?:left|right) of the (?:page|screen)"
)
"""Keys and places that only a page of a desktop has, and dashes that depend on how many traces a scope shows."""

HEAD = """+++
schema = 1
title = "A sheet"
summary = "Of a test."
minutes = 10
[bench]
scenario = "first-look"
+++
"""
STEP = """
## One

```step
id = "one"
kind = "question"
points = 2.0
question = "How much?"
[number]
value = "f0_hz"
unit = "Hz"
```
"""


def question(**number: object) -> SheetQuestion:
    asked = {"value": 2000.0, "unit": "Hz", "within": 0.02, **number}
    return SheetQuestion.model_validate(
        {"id": "q", "kind": "question", "points": 2.0, "question": "How much?", "number": asked}
    )


@pytest.mark.parametrize(
    ("text", "share", "reason"),
    [
        ("2000 Hz", 1.0, "right"),
        ("2.01 kHz", 1.0, "right"),
        ("0.002MHz", 1.0, "right"),
        ("2e3 Hz", 1.0, "right"),
        ("2.1 kHz", 0.5, "within 10 %"),
        ("2000", 0.4, "right value, no unit"),
        ("2", 0.4, "right value, no unit"),
        ("2000 V", 0.4, "right value, wrong unit"),
        ("2 Hz", 0.4, "right value, wrong unit"),
        ("−2 kHz", 0.3, "right value, wrong sign"),
        ("12.57 kHz", 0.25, "that is per radian"),
        ("3 kHz", 0.1, "right sign, wrong value"),
        ("-3 kHz", 0.0, "wrong"),
        ("3 V", 0.0, "wrong, and wrong unit"),
    ],
)
def test_an_answer_earns_what_its_rule_says_with_the_reason(text: str, share: float, reason: str) -> None:
    step = question(
        partly={"within": 0.1, "share": 0.5},
        wrong_unit=0.4,
        wrong_sign=0.3,
        right_sign=0.1,
        mistakes=[{"value": "2000*2*pi", "share": 0.25, "because": "that is per radian"}],
    )
    verdict = judge(step, text, {})
    assert verdict.share == share
    assert verdict.reason.replace("\u00a0", " ").startswith(reason)


@pytest.mark.parametrize("text", ["", "about two", "2,5 kHz", "nan Hz", "inf", "1e999 Hz", "x" * 300])
def test_an_answer_that_cannot_be_read_is_refused_and_costs_nothing(text: str) -> None:
    with pytest.raises(InputError, match="answer"):
        parse_quantity(text)


@given(
    st.floats(1e-17, 1e14).flatmap(lambda x: st.sampled_from([x, -x])),
    st.sampled_from(["Hz", "um", "ms", "V", "N/m", "um/V", "kg", "mg", "fF", "s", "N s/m"]),
)
def test_what_the_bench_writes_it_reads_again(value: float, unit: str) -> None:
    wanted = parse_quantity(f"{value!r} {unit}")
    found = parse_quantity(format_si(value, unit, 9).replace("e−", "e-"))
    assert found.base == wanted.base
    assert found.value == pytest.approx(wanted.value, rel=1e-6)


@pytest.mark.parametrize(
    "formula",
    [
        "__import__('os')",
        "f0_hz.__class__",
        "(lambda: 1)()",
        "[1 for _ in (1,)]",
        "9**9**9",
        "open('/etc/passwd')",
        "1/0",
        "unknown_fact",
        "sqrt",
        "'a'*9",
        "1 if 1 else 2",
        "f0_hz == f0_hz",
        "x := 3",
    ],
)
def test_a_formula_does_arithmetic_and_nothing_else(formula: str) -> None:
    with pytest.raises(InputError):
        evaluate(formula, {"f0_hz": 2000.0}, "value")


def test_a_formula_has_the_value_of_its_closed_form() -> None:
    assert evaluate("sqrt(k/m)/(2*pi)", {"k": 0.0538, "m": 2.209e-10}) == pytest.approx(2483.78, rel=1e-5)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("no front matter", "line 1"),
        (HEAD, "has no section"),
        (HEAD.replace("minutes = 10", "minutes = ten") + STEP, "line 5"),
        (HEAD.replace("minutes = 10", "minutes = 1000") + STEP, "line 5, minutes: must be <= 90"),
        (HEAD.replace("first-look", "first-lok") + STEP, "unknown scenario"),
        (HEAD + STEP.replace("points = 2.0", "points = true"), "line 15, step one, points: must be a number"),
        (HEAD + STEP.replace("[number]", "trys = 2\n[number]"), "line 17, step one, trys: unknown field"),
        (HEAD + STEP.replace('"f0_hz"', '"f0_khz"'), "line 18, step one, number.value: unknown fact"),
        (HEAD + STEP.replace("f0_hz", "__class__"), "step one, number.value"),
        (HEAD + STEP + STEP.replace("## One", "## Two"), "is the id of line 12 too"),
        (HEAD + STEP.replace("```\n", ""), "the step has no end"),
        (HEAD + STEP + "\n{{ nonsense | Hz }}", "unknown fact"),
        (HEAD + STEP.replace('kind = "question"', 'kind = "quiz"'), "step one"),
    ],
)
def test_a_sheet_that_is_not_right_is_refused_with_its_line_step_and_field(text: str, said: str) -> None:
    with pytest.raises(InputError) as refused:
        check(text, "mine")
    assert str(refused.value).startswith("sheet mine, line ")
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ('signal = "plant.speed"', "conditions.0.signal: unknown signal"),
        ('verdict = "kalmann", equals = "healthy"', "conditions.0.verdict: unknown diagnoser"),
        ('verdict = "kalman", equals = "sick"', "conditions.0.equals: unknown hypothesis"),
        ('setting = "reference.colour"', "conditions.0.setting: unknown field"),
        ('fault = "added_mass", setting = "controller.kind"', "needs one of signal, setting, verdict, fault"),
    ],
)
def test_a_condition_names_what_the_bench_has(change: str, said: str) -> None:
    ends = "" if "equals" in change else ", between = [0.0, 1.0]"
    step = f"""
## One
```step
id = "one"
kind = "hold"
points = 1.0
for_ms = 1.0
conditions = [{{ label = "A", {change}{ends} }}]
```
"""
    with pytest.raises(InputError, match="line 16, step one") as refused:
        check(HEAD + step, "mine")
    assert said in str(refused.value)


def test_a_number_without_its_unit_is_taken_in_any_prefix_of_the_unit_asked_for() -> None:
    in_khz = question(value=2.0, unit="kHz", wrong_unit=0.4)
    shares = {
        text: judge(in_khz, text, {}).share for text in ("2 kHz", "2000 Hz", "2", "2000", "0.002", "3", "-2", "0")
    }
    assert shares == {"2 kHz": 1.0, "2000 Hz": 1.0, "2": 0.4, "2000": 0.4, "0.002": 0.4, "3": 0.0, "-2": 0.0, "0": 0.0}


def test_a_number_that_is_to_be_0_may_be_nearly_so() -> None:
    zero = question(value=0.0)
    assert judge(zero, "1e-13 Hz", {}).share == 1.0 and judge(zero, "1e-6 Hz", {}).share == 0.0


def test_a_formula_is_not_too_long() -> None:
    assert evaluate("1" + "+1" * 149, {}) == 150.0
    with pytest.raises(InputError, match="at most 300 characters"):
        evaluate("1" + "+1" * 150, {})


def test_draws_need_two_numbers_and_a_prediction_one_try() -> None:
    with pytest.raises(InputError, match="less than one step above low"):
        check(HEAD.replace("[bench]", "[draws]\nx = { low = 1.0, high = 1.5, step = 1.0 }\n[bench]") + STEP, "mine")
    with pytest.raises(InputError, match="tries"):
        guess = STEP.replace('kind = "question"', 'kind = "prediction"\nuntil = "two"\ntries = 2')
        check(HEAD + guess + STEP.replace('"one"', '"two"').replace("## One", "## Two"), "mine")


def test_a_prediction_is_judged_behind_a_later_step() -> None:
    text = HEAD + STEP.replace('kind = "question"', 'kind = "prediction"\nuntil = "one"')
    with pytest.raises(InputError, match="is no later step"):
        check(text, "mine")


def test_what_is_drawn_differs_by_student_and_stays_the_same_for_one() -> None:
    sheet = sheets.get("resonance-and-q")
    found = [begin(sheet, lambda what, seed=seed: hash((what, seed)) % 2**31).facts["f0_hz"] for seed in range(6)]
    assert len(set(found)) == 6
    assert begin(sheet, lambda _: 7) == begin(sheet, lambda _: 7)


def test_who_tries_all_options_earns_nothing_and_a_guess_gains_nothing_on_average() -> None:
    for name in sheets.ids():
        for step in sheets.get(name).steps:
            if isinstance(step, SheetQuestion) and step.choice is not None:
                wrong = [option for option in step.choice.options if option.share == 0.0]
                rights = len(step.choice.options) - len(wrong)
                guessed = sum(o.share * step.points for o in step.choice.options) - len(wrong) * step.costs
                assert guessed / len(step.choice.options) <= step.points * (rights - 1) / len(step.choice.options)
                assert step.points - len(wrong) * step.costs <= step.points * (rights - 1) / rights


def test_a_prediction_is_given_once_and_its_worth_is_not_told_before_the_run() -> None:
    sheet, progress = sheets.get("first-look"), Progress(facts={"amplitude": 2.0, "growth": 3.0})
    progress.held(sheet.steps[0], [1.0], {}, 10)  # type: ignore[arg-type]
    progress.go_on(sheet, "amplitude", 20)
    with pytest.raises(InputError, match="a prediction comes before the run"):
        progress.go_on(sheet, "guess", 30)
    with pytest.raises(InputError, match="is closed until step guess is done"):
        progress.answer(sheet, "growth", "3 %", 30)
    progress.answer(sheet, "guess", "grows", 30)
    assert not progress.is_told(sheet, sheet.steps[2])
    before = progress.points(sheet)
    with pytest.raises(InputError, match="is done and cannot be changed"):
        progress.answer(sheet, "guess", "shrinks", 40)
    progress.held(sheet.steps[3], [0.05, "m+5"], {}, 50)  # type: ignore[arg-type]
    assert progress.points(sheet) == before + sheet.steps[2].points + sheet.steps[3].points


@pytest.mark.parametrize(
    ("fault", "unit", "said"),
    [("added_mass", "", "5.00\u00a0%"), ("stiction", "", "50.0\u00a0pN"), ("added_mass", "um", "50.0\u00a0nm")],
)
def test_the_severity_of_a_fault_is_written_as_the_page_writes_it(fault: str, unit: str, said: str) -> None:
    limits = Limits(label="fault", fault=fault, between=(0.0, 1.0), unit=unit)
    assert value_text(limits, 0.05) == said
    assert wanted_text(limits, (0.0, 0.0)).startswith("0")


@pytest.mark.parametrize("name", sheets.ids())
def test_a_sheet_names_no_key_and_no_place_that_a_phone_lacks(name: str) -> None:
    text = (files(sheets) / f"{name}.md").read_text("utf-8")
    assert DESKTOP_ALONE.findall(text) == []

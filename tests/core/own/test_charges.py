"""The arguments of each function in declarations and in `pack` are counted, by their length, before the call."""

from __future__ import annotations

import ast
from contextlib import suppress
from typing import Any

import pytest

from core.block import Context, Oscillator
from core.control.controller import advance_lag, lag
from core.elementary import exp
from core.errors import InputError
from core.own.evaluate import MOST_ITEMS, MOST_OPERATIONS, Evaluator
from core.own.offered import BUILTINS, OFFERED, PYTHON
from core.own.text import UnitError
from core.own.unit import unit
from core.record import Record, Vector, vector
from tests.core.own.texts import odd


class Wide(Record):
    """As many numbers as a record may have."""

    numbers: Vector = vector(4096)


def nested(deep: int) -> list[Any]:
    """Return a list of the same lists, again and again: a few of them in memory, ten thousand to the power written."""
    inner: list[Any] = [1.0] * MOST_ITEMS
    for _ in range(deep):
        inner = [inner] * MOST_ITEMS
    return inner


GIVEN: dict[str, Any] = {
    "number": 2.0**53,
    "large": -(2**53),
    "small": 1e-300,
    "truth": True,
    "nothing": None,
    "text": "9" * 60_000,
    "numbers": [1.0] * MOST_ITEMS,
    "whole": (7,) * MOST_ITEMS,
    "texts": ["9" * 60_000] * MOST_ITEMS,
    "lists": nested(1),
    "deep": nested(4),
    "record": Wide.zeros(),
    "vector": Wide.zeros().numbers,
}
LONG = {"numbers", "whole", "texts", "lists", "deep"}


def counted(text: str) -> tuple[int, Any]:
    """Return how many operations an expression counts as, and its value; all that may be counted if it is refused."""
    evaluator = Evaluator({**BUILTINS, **GIVEN})
    try:
        value = evaluator.constant(ast.parse(text, mode="eval").body)
    except UnitError:
        return MOST_OPERATIONS, None
    return MOST_OPERATIONS - evaluator._left, value


@pytest.mark.parametrize("name", [function.__name__ for function in PYTHON])
def test_each_function_of_python_counts_what_it_takes_and_makes(name: str) -> None:
    _, most = PYTHON[BUILTINS[name]]
    for first in GIVEN:
        for rest in ((), *((other,) for other in ("number", "numbers", "deep") if most > 1)):
            operations, value = counted(f"{name}({', '.join((first, *rest))})")
            made = len(value) if isinstance(value, list | tuple) else 0
            taken = MOST_ITEMS * sum(one in LONG for one in (first, *rest)) if value is not None else 0
            assert operations >= max(made, taken), (first, rest)


@pytest.mark.parametrize("sign", ["<", "<=", ">", ">=", "==", "!="])
def test_numbers_are_compared_and_nothing_that_takes_long(sign: str) -> None:
    for name in LONG:
        with pytest.raises(UnitError, match="compares something that is no number"):
            Evaluator(GIVEN).constant(ast.parse(f"{name} {sign} {name}", mode="eval").body)


@pytest.mark.parametrize(
    "text",
    [
        "round(7, -1000000000)",
        "sum([[1.0], [2.0]], [])",
        "max([1.0], [2.0])",
        "max([1.0, 2.0], key=len)",
        "min('a', 'b')",
        "int('9')",
        "float('1e400')",
        "str([1.0])",
    ],
)
def test_calls_that_may_take_long_or_take_no_numbers_are_refused(text: str) -> None:
    with pytest.raises(UnitError):
        unit("odd", odd("top", f"K = {text}"))


def test_all_declarations_of_a_unit_share_one_count() -> None:
    many = "\n".join(f"A{i} = len([0 for j in range(9999)])" for i in range(60))
    with pytest.raises(UnitError, match=f"takes more than {MOST_OPERATIONS} operations"):
        unit("odd", odd("top", many))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("p.gain = exp([1.0])", "is given something of another kind"),
        ("p.gain = exp(p)", "is given something of another kind"),
        ("p.gain = exp()", "takes 1 arguments by their place"),
        ("p.gain = advance_lag(p, 1.0, 1.0, 0.0, 0.0)", "is given something of another kind"),
        ("p.lag = lag([1.0], 0.1, False)", "pole must be a number"),
        ("p.lag = lag(p.taps, 0.1, False)", "pole must be a number"),
    ],
)
def test_a_function_of_the_library_refuses_in_pack_what_it_does_not_take(text: str, said: str) -> None:
    block = unit("odd", odd("pack", text)).block
    with pytest.raises(InputError, match=said):
        block.packed(block.Params(), context())


@pytest.mark.parametrize("given", ["p.taps", "p, p, p", "context", "'x', 'x'", "1, 1, True", "[1.0], 1.0"])
def test_no_function_of_the_library_fails_in_pack_otherwise_than_in_one_line(given: str) -> None:
    for module, names in OFFERED.items():
        for name in names if module != "__future__" else ():
            text = odd("pack", f"a = fun({given})", top=f"from {module} import {name} as fun")
            with suppress(InputError):
                block = unit("odd", text).block
                block.packed(block.Params(), context())


def test_kernels_of_the_library_run_in_pack_as_they_do_compiled() -> None:
    block = unit("odd", odd("pack", "p.gain = exp(0.3) + advance_lag(p.lag, 1, 0.5, 0.25, 0.125)")).block
    expected = exp(0.3) + advance_lag.py_func(lag(1.0, 0.1, False), 1.0, 0.5, 0.25, 0.125)  # type: ignore[attr-defined]
    assert block.Packed(block.packed(block.Params(), context())).gain == expected


def context() -> Any:
    device = Oscillator(1.0, 0.1, 4.0, -0.5)
    return Context(0.01, 1, 1, device, device)


def test_a_long_loop_over_records_is_refused() -> None:
    text = "a = [cls.State.zeros() for i in range(9999)]"
    block = unit("odd", odd("pack", text, state="more: Vector = vector(4000)")).block
    with pytest.raises(UnitError, match="takes more than"):
        block.packed(block.Params(), context())

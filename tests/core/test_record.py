"""Records and ports: the places of names, and the same names compiled and in plain Python."""

from __future__ import annotations

import ctypes
import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.compile import code
from core.compile.numbers import Unsupported
from core.kernel import flush_tiny, kernel
from core.plain import plain
from core.ports import TICK, TIME_MS, BlockPorts, output, reads, tap
from core.record import Record, Records, Vector, several, tail, vector


class Point(Record):
    x: float
    v: float


class Base(Record):
    first: float
    pair: Vector = vector(2)


class Everything(Base):
    point: Point
    points: Records[Point] = several(3)
    last: float
    window: Vector = tail()


class Twins(Record):
    count: float
    left: Vector = tail()
    right: Vector = tail()


class Rows(Record):
    rows: Records[Point] = tail()


class FirstPorts(BlockPorts):
    measured: float = reads("sensor.displacement", "um", "measured")
    voltage: float = output("V", "voltage")


class SecondPorts(BlockPorts):
    engaged: float = reads("@engaged", "1", "drives")


class Ports(FirstPorts, SecondPorts):
    shown: Vector = tap("1", "shown", labels=("a", "b", "c"))
    extra: float = reads("plant.velocity", "um/ms", "velocity")
    voltage: float = output("V", "voltage, told otherwise")


def test_fields_of_bases_come_first_and_tails_last():
    places = {field.name: field.offset for field in Everything.layout.fields}
    assert places == {"first": 0, "pair": 1, "point": 3, "points": 5, "last": 11, "window": 0}
    assert Everything.layout.size == 12 and Everything.layout.numbers(5) == 17


def test_names_are_places_of_the_array():
    record = Everything.zeros(4)
    record.first, record.last = 1.0, 2.0
    record.pair[:] = 3.0, 4.0
    record.point.v = 5.0
    record.points[2].x = 6.0
    record.window[3] = 7.0
    expected = np.zeros(16)
    expected[[0, 11, 1, 2, 4, 9, 15]] = 1, 2, 3, 4, 5, 6, 7
    np.testing.assert_array_equal(record.array, expected)
    assert [point.x for point in record.points] == [0.0, 0.0, 6.0]


def test_a_record_that_is_assigned_is_copied():
    record, point = Everything.zeros(), Point.zeros()
    point.x = 3.0
    record.point = point
    point.x = 4.0
    assert record.point.x == 3.0


def test_tails_share_one_length():
    record = Twins.zeros(3)
    record.left[:], record.right[:] = 1.0, 2.0
    np.testing.assert_array_equal(record.array, [0, 3, 1, 1, 1, 2, 2, 2])


def test_blanks_are_named_until_they_are_packed():
    record = Everything.blank()
    assert record.blanks() == ["first", "point.x", "point.v", "last"]
    record.first, record.last, record.point = 0.0, math.nan, Point.zeros()
    assert record.blanks() == []


@pytest.mark.parametrize("hint", ["int", "Vector", "Records[Point]"])
def test_a_field_that_cannot_be_laid_out_is_named(hint):
    scope = {"Record": Record, "Vector": Vector, "Records": Records, "Point": Point, "__name__": __name__}
    with pytest.raises(TypeError, match=r"Odd\.field: declare float"):
        exec(f"class Odd(Record):\n    field: {hint}\n", scope)


def test_a_port_without_a_declaration_is_named():
    with pytest.raises(TypeError, match=r"Odd\.port: declare reads"):

        class Odd(BlockPorts):
            port: float


def test_ports_are_sorted_by_kind_and_keep_the_places_of_their_bases():
    assert [port.name for port in Ports.declared] == ["measured", "engaged", "extra", "voltage", "shown"]
    assert Ports.declared[3].meaning == "voltage, told otherwise"
    assert FirstPorts.declared[1].meaning == "voltage"
    assert [port.vector for port in Ports.declared] == [False, False, False, False, True]


def test_ports_read_and_write_signals():
    w, places = np.arange(20.0), np.array([7, 5, 4, 9, 11])
    x = Ports(w, places)
    assert (x.measured, x.engaged, x.extra, x.tick, x.time_ms) == (7.0, 5.0, 4.0, TICK, TIME_MS)
    x.voltage = -1.0
    x.shown[2] = -2.0
    assert w[9] == -1.0 and w[13] == -2.0


@kernel
def push(point: Point, u: float) -> float:
    point.v = flush_tiny(point.v + u)
    point.x += point.v
    return point.x


def everything(p: Everything, s: Everything, x: Ports) -> None:
    total = 0.0
    for i in range(3):
        total += push(s.points[i], p.points[i].x * x.measured)
    s.point.x = total
    for i in range(2):
        s.pair[i] += p.pair[i]
        x.shown[i] = s.pair[i]
    s.window[1] += p.window[0] * x.tick
    s.last = s.window[1]
    if x.engaged > 0.5:
        x.voltage = s.last + p.first + p.last
        return
    x.voltage = p.point.v


def doubled(p: Twins, s: Twins, x: FirstPorts) -> None:
    for i in range(int(p.count)):
        s.right[i] = p.left[i] + 2.0 * p.right[i]
        s.left[i] += s.right[i] * x.measured
    x.voltage = s.left[0]


def walked(p: Rows, s: Rows, x: FirstPorts) -> None:
    for i in range(2):
        s.rows[i].v += p.rows[i].x
        x.voltage = push(s.rows[i], x.measured)


@cache
def unit(step, p, s, x):
    return type(step.__name__, (), {"step": step, "Packed": p, "State": s, "Ports": x})


def call(step, p, s, x) -> None:
    """Call the compiled step as the loop of the board does."""
    entry = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)(code.address(unit(step, type(p), type(s), type(x))))
    entry(p.address, s.address, x.signals.ctypes.data, x.places.ctypes.data)


numbers = st.floats(-1e3, 1e3)


@pytest.mark.parametrize(
    ("step", "p", "s", "ports", "length"),
    [
        (everything, Everything, Everything, Ports, 3),
        (doubled, Twins, Twins, FirstPorts, 2),
        (doubled, Twins, Twins, FirstPorts, 7),
        (walked, Rows, Rows, FirstPorts, 2),
    ],
)
@given(data=st.data())
def test_compiled_and_plain_steps_give_the_same_bits(step, p, s, ports, length, data):
    parameters, start = p.zeros(length), s.zeros(length)
    fixed = p.layout.size - 1 if p is Twins else 0
    for record in (parameters, start):
        for place in range(len(record.array)):
            if p is not Twins or place != fixed:
                record.array[place] = data.draw(numbers)
    if p is Twins:
        parameters.count = length
    w = np.array(data.draw(st.lists(numbers, min_size=16, max_size=16)))
    places = np.array([7, 5, 4, 9, 11][: len(ports.declared)] if ports is Ports else [7, 9])
    fast, slow = (s(start.array.copy()), w.copy()), (s(start.array.copy()), w.copy())
    for tick in range(3):
        fast[1][TICK] = slow[1][TICK] = tick
        call(step, parameters, fast[0], ports(fast[1], places))
        plain(step)(parameters, slow[0], ports(slow[1], places))
    np.testing.assert_array_equal(fast[0].array, slow[0].array)
    np.testing.assert_array_equal(fast[1], slow[1])


def test_python_may_call_a_kernel_with_a_record():
    point = Point.zeros()
    point.v = 2.0
    assert push(point, 1.5) == 3.5 and point.v == 3.5 and point.x == 3.5


def test_a_misspelt_name_is_refused_by_the_compiler():
    def misspelt(p: Point, s: Point, x: FirstPorts) -> None:
        x.voltage = p.y  # type: ignore[attr-defined]

    line = misspelt.__code__.co_firstlineno + 1
    with pytest.raises(Unsupported, match="no field y") as raised:
        code.address(unit(misspelt, Point, Point, FirstPorts))
    assert raised.value.field == f"{__file__}:{line}:21"

"""Handmade WebAssembly with operations that no unit may have: it reaches nothing, and the bench continues."""

from __future__ import annotations

import ctypes
import inspect
import subprocess
import sys
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from core.control import pid
from core.errors import InputError
from core.wall import code, host, wall
from core.wall.crossing import Crossing, PortSignal, Sizes
from scenarios import wall as built
from scenarios.run import build
from tests.core.own.test_own_units import with_unit
from tests.core.own.texts import PI, ROOT

BEGIN = "define void @step(ptr %p, ptr %s, ptr %w, ptr %io) {\n"
GOOD = "%v = load double, ptr %p\nstore double %v, ptr %s\nret void\n}"
FAR = "%far = getelementptr double, ptr %p, i64 {}\n"
END = "ret void\n}"
STOP = "call void @llvm.trap()\n" + END + "\ndeclare void @llvm.trap()"
BAD = {
    "reads beyond": FAR.format(16777216) + "%v = load volatile double, ptr %far\n" + END,
    "writes before": FAR.format(-99999) + "store volatile double 1.0, ptr %far\n" + END,
    "never ends": "br label %a\na:\n%v = load volatile double, ptr %p\nbr label %a\n}",
    "calls itself": "call void @step(ptr %p, ptr %s, ptr %w, ptr %io)\nstore volatile double 2.0, ptr %s\n" + END,
    "stops": STOP,
    "leaves its stack": "%r = alloca [64 x double]\nstore volatile double 1.0, ptr %r\n" + STOP,
}
SIZES = Sizes(2, 2, (PortSignal("in", 1, False), PortSignal("out", 1, True), PortSignal("three", 3, True)))


@pytest.fixture(autouse=True)
def _wall() -> Iterator[None]:
    yield
    wall.demand(False)


STOPS_BELOW_0 = (
    "%r = alloca [64 x double]\n%in = getelementptr double, ptr %w, i64 2\n%v = load double, ptr %in\n"
    "store volatile double %v, ptr %r\ncall void @g(ptr %r)\n%u = load volatile double, ptr %r\n"
    "%out = getelementptr double, ptr %w, i64 3\nstore double %u, ptr %out\nret void\n}\n"
    "define void @g(ptr %r) noinline {\n%v = load volatile double, ptr %r\n%bad = fcmp olt double %v, 0.0\n"
    "br i1 %bad, label %stop, label %go\nstop:\ncall void @llvm.trap()\nunreachable\ngo:\nret void\n}\n"
    "declare void @llvm.trap()"
)
"""A step with numbers on its stack, which it passes on."""


def way(body: str) -> tuple[Crossing, Callable[..., None]]:
    """Return the way to a step written by hand, and what calls it."""
    module = host.module_of(code.compiled(BEGIN + body))
    crossing = Crossing([host.instance_of(module, SIZES.total)], SIZES, 1)
    step = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * 4)(crossing.address)
    return crossing, lambda *arrays: step(*(array.ctypes.data for array in arrays))


def called(body: str, times: int = 1) -> tuple[list[float], list[float], list[float]]:
    """Return parameters, state and signals after calls of a step written by hand."""
    _kept, step = way(body)
    p, s, w, io = np.array([3.0, 4.0]), np.array([5.0, 6.0]), np.arange(20.0), np.array([7, 9, 12])
    for _ in range(times):
        step(p, s, w, io)
    return p.tolist(), s.tolist(), w.tolist()


def test_a_good_step_computes() -> None:
    assert called(GOOD) == ([3.0, 4.0], [3.0, 6.0], [float(i) for i in range(20)])


@pytest.mark.parametrize("body", BAD.values(), ids=BAD)
def test_a_step_that_leaves_its_memory_puts_out_no_number_and_keeps_its_state(body: str) -> None:
    p, s, w = called(body, 300)
    wanted = [np.nan if i in (9, 12, 13, 14) else float(i) for i in range(20)]
    assert (p, s) == ([3.0, 4.0], [5.0, 6.0])
    np.testing.assert_array_equal(w, wanted)


def test_a_step_that_failed_a_thousand_times_computes_again() -> None:
    """Each failure leaves 512 bytes on the stack of a memory of 192 kB, unless it is put back."""
    _kept, step = way(STOPS_BELOW_0)
    p, s, w, io = np.zeros(2), np.zeros(2), np.zeros(20), np.array([7, 9, 12])
    for value, wanted in ((-1.0, np.nan), (3.5, 3.5)):
        for _ in range(1000):
            w[7] = value
            step(p, s, w, io)
        np.testing.assert_array_equal(w[9], wanted)


def test_what_a_step_may_not_write_stays_as_it_is() -> None:
    """Addresses in its memory are all its own, so it can write over its copies of parameters and inputs."""
    far = "%port = getelementptr double, ptr %w, i64 2\nstore double 9.0, ptr %port\nstore double 9.0, ptr %p\n"
    p, _, w = called(far + "ret void\n}")
    assert p == [3.0, 4.0] and w == [float(i) for i in range(20)]


def test_a_step_that_lies_about_the_places_of_its_ports_reaches_no_other_signal() -> None:
    lie = "store i64 9999999, ptr %io\n%one = getelementptr i64, ptr %io, i64 1\nstore i64 -4, ptr %one\n" + END
    assert called(lie, 3)[2] == [float(i) for i in range(20)]


def test_a_driving_unit_that_leaves_its_memory_trips_the_board_and_in_shadow_disturbs_nobody(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plain = build(with_unit("pi", PI + "\n# plain\n"))
    plain.advance(200)
    monkeypatch.setattr("core.wall.wall.kept", lambda _: code.compiled(BEGIN + BAD["reads beyond"]))
    wall.demand()
    driving = build(with_unit("pi", PI + "\n# driving\n", {"controller.kind": "pi"}))
    driving.advance(200)
    assert driving.trip is not None and driving.trip.signal == "pi.voltage" and driving.trip.tick <= 1
    shadow = build(with_unit("pi", PI + "\n# shadow\n"))
    shadow.advance(200)
    assert shadow.trip is None and np.isnan(shadow.value("pi.voltage"))
    assert shadow.digest() == plain.digest()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (b"no module", "is no WebAssembly"),
        ('(module (import "env" "open" (func)) (func (export "step")))', "asks for env.open"),
        ('(module (import "wasi_snapshot_preview1" "__linear_memory" (memory 1)))', "asks for wasi"),
        ('(module (import "env" "__linear_memory" (global i32)))', "asks for env.__linear_memory"),
        ('(module (func (export "step")))', "offers something else"),
        (
            '(module (memory (export "memory") 1) (func (export "step") (param i32 i32 i32 i32))'
            ' (func (export "room") (result i32) i32.const 0))',
            "offers something else",
        ),
        (bytes(host.MOST_BYTES + 1), "more than 4 MB"),
    ],
)
def test_a_module_that_asks_for_more_is_not_let_in(text: Any, said: str) -> None:
    import wasmtime

    with pytest.raises(InputError, match=said):
        host.module_of(text if isinstance(text, bytes) else bytes(wasmtime.wat2wasm(text)))


@pytest.mark.parametrize("body", ["i32.const -8", "i32.const 1048576", "unreachable", "i32.const 4"])
def test_a_module_that_lies_about_its_room_is_not_let_in(body: str) -> None:
    import wasmtime

    text = f'(module (func (export "step") (param i32 i32 i32 i32)) (func (export "room") (result i32) {body}))'
    module = host.module_of(bytes(wasmtime.wat2wasm(text)))
    with pytest.raises(InputError, match=r"does not fit|no place"):
        host.instance_of(module, 10)


def test_memory_has_a_limit_and_does_not_grow() -> None:
    import wasmtime

    step = '(import "env" "__linear_memory" (memory 1)) (func (export "step") (param i32 i32 i32 i32))'
    grown = "(i32.eq (memory.grow (i32.const 1)) (i32.const -1))"
    room = f'(func (export "room") (result i32) (select (i32.const 64) (i32.const -8) {grown}))'
    text = f"(module {step} {room})"
    module = host.module_of(bytes(wasmtime.wat2wasm(text)))
    assert host.instance_of(module, 10).room == 64, "a memory that grew would have said -8"
    with pytest.raises(InputError, match="more than 4 MB"):
        host.instance_of(module, 1 << 20)


def test_a_function_from_outside_is_refused_where_it_is_compiled() -> None:
    with pytest.raises(InputError, match="calls system"):
        code.compiled("declare void @system(ptr)\n" + BEGIN + "call void @system(ptr %p)\nret void\n}")


def test_without_the_package_the_wall_is_not_built_and_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "wasmtime", None)
    host.machine.cache_clear()
    with pytest.raises(InputError, match="wasmtime") as raised:
        built.build()
    assert raised.value.field == "units" and "'.[wall]' in a checkout" in raised.value.hint
    assert not wall.is_demanded()


def test_a_wall_that_gives_other_bits_is_not_built(monkeypatch: pytest.MonkeyPatch) -> None:
    """The unit has a line more than any that was compiled before, so that it is one of its own."""
    unit = {"pid": {"source": inspect.getsource(pid) + "\nOTHER = 1\n"}}
    monkeypatch.setattr("core.wall.wall.kept", lambda _: code.compiled(BEGIN + GOOD))
    monkeypatch.setattr(built, "with_unit", lambda: {**built.BENCH, "units": unit})
    with pytest.raises(InputError, match="other bits"):
        built.build()
    assert not wall.is_demanded()


def test_nothing_of_the_wall_is_loaded_where_nobody_wants_it() -> None:
    text = "import sys, server.app, scenarios.own; assert 'wasmtime' not in sys.modules"
    subprocess.run([sys.executable, "-c", text], cwd=ROOT, check=True)

"""Kernels and steps as a module in WebAssembly, run by wasmtime, against the same kernels in plain Python."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from core import kernel_cache
from core.board import fold
from core.compile import code
from core.compile.instructions import address_of, call
from core.compile.segment import SegmentStep
from core.errors import InputError
from core.kernel import kernel
from core.wall.host import machine
from core.wasm import target
from core.wasm.module import OfferedKernel, module_of
from tests.core.compile.test_widths import MemoryShelf

PAGE = 1 << 16
PAGES = 40


class RunModule:
    """A module in a memory of its own, into which arrays are copied for a call and back."""

    def __init__(self, code: bytes) -> None:
        wasmtime = machine()
        self.store = wasmtime.Store()
        self.memory = wasmtime.Memory(self.store, wasmtime.MemoryType(wasmtime.Limits(PAGES, PAGES)))
        kind = wasmtime.GlobalType(wasmtime.ValType.i32(), mutable=True)
        stack = wasmtime.Global(self.store, kind, wasmtime.Val.i32(PAGES * PAGE))
        module = wasmtime.Module(self.store.engine, code)
        lent = {"__linear_memory": self.memory, "__stack_pointer": stack}
        self.asked = [one.name for one in module.imports]
        self.exports = wasmtime.Instance(self.store, module, [lent[one] for one in self.asked]).exports(self.store)

    def call(self, name: str, *given: Any) -> float:
        """Call a kernel, and return the first number of its result."""
        results = at = -(-int(self.exports["room"](self.store)) // 64) * 64
        taken: list[Any] = [results]
        arrays = []
        for one in given:
            if isinstance(one, np.ndarray):
                at = -(-(at + 64) // 64) * 64
                self.memory.write(self.store, one.tobytes(), at)
                arrays.append((one, at))
                taken += [at, *one.shape]
                at += one.nbytes
            else:
                taken.append(float(one))
        self.exports[name](self.store, *taken)
        for one, place in arrays:
            one.ravel()[:] = np.frombuffer(self.memory.read(self.store, place, place + one.nbytes), one.dtype)
        return float(np.frombuffer(self.memory.read(self.store, results, results + 8), np.float64)[0])


@kernel
def _largest(numbers: Any, least: float, last: int) -> float:
    found = least
    for i in range(last):
        found = max(found, numbers[i])
    return found


@kernel
def _called(p: Any, s: Any, w: Any, io: Any, number: int) -> None:
    call(number, address_of(p), address_of(s), address_of(w), address_of(io))


def test_a_kernel_of_numbers_and_an_array_gives_what_python_gives():
    module = RunModule(
        module_of({"largest": OfferedKernel(_largest.py_func, (("float64", 1), "float64", "int64"))}, [])
    )
    numbers = np.array([0.25, -3.0, 7.5, 9.0])
    assert module.call("largest", numbers, -1.0, 3) == _largest.py_func(numbers, -1.0, 3) == 7.5
    assert module.call("largest", numbers, 100.0, 4) == 100.0


def test_the_fold_of_a_sample_has_the_same_bits_and_takes_every_nan_for_one():
    kinds = (("uint64", 2), ("uint64", 1))
    module = RunModule(module_of({"fold": OfferedKernel(fold.fold.py_func, kinds)}, []))
    samples = np.array([0.1, -0.0, np.inf, np.nan, 5e-324]).view(np.uint64)
    samples[3] |= np.uint64(1) << np.uint64(63)  # a NaN as another processor gives it
    found, expected = fold.begin(5), fold.begin(5)
    for _ in range(3):
        module.call("fold", found, samples)
        fold.fold(expected, samples)
    np.testing.assert_array_equal(found, expected)


def test_a_step_is_called_by_its_number(step_of: Callable[[float], Any]):
    kinds = (("float64", 1), ("float64", 1), ("float64", 1), ("int64", 1), "int64")
    steps = [step_of(2.0), step_of(3.0)]
    module = RunModule(module_of({"called": OfferedKernel(_called.py_func, kinds)}, steps))
    for number, factor in ((0, 2.0), (1, 3.0)):
        signals = np.array([0.0, 0.0, 1.25, 0.0])
        module.call("called", np.zeros(1), np.zeros(1), signals, np.array([2, 3]), number)
        assert signals.tolist() == [0.0, 0.0, 1.25, 1.25 * factor]
    assert set(module.asked) <= {"__linear_memory", "__stack_pointer"}


def test_a_segment_is_called_by_its_number_and_runs_its_steps_in_their_order(step_of: Callable[[float], Any]):
    double, triple = step_of(2.0), step_of(3.0)
    segment = (SegmentStep(double, 1, 0, 0, 0, ()), SegmentStep(triple, 1, 0, 0, 2, ((0, 3),)))
    kinds = (("float64", 1), ("float64", 1), ("float64", 1), ("int64", 1), "int64")
    module = RunModule(module_of({"called": OfferedKernel(_called.py_func, kinds)}, [double, triple, segment]))
    signals = np.array([0.0, 0.0, 1.25, 0.0, 0.0])
    module.call("called", np.zeros(1), np.zeros(1), signals, np.array([2, 3, 0, 4]), 2)
    assert signals.tolist() == [0.0, 0.0, 1.25, 2.5, 7.5]  # the place of port 0 is known, so it is not read


def test_a_module_is_kept_whole_under_its_steps_in_their_order(
    step_of: Callable[[float], Any], monkeypatch: pytest.MonkeyPatch
):
    made, emitted = list[int](), target.emitted
    monkeypatch.setattr(kernel_cache, "_shelves", [MemoryShelf()])
    monkeypatch.setattr(target, "emitted", lambda *given, **named: made.append(1) or emitted(*given, **named))
    kinds = (("float64", 1), ("float64", 1), ("float64", 1), ("int64", 1), "int64")
    called, (double, triple) = {"called": OfferedKernel(_called.py_func, kinds)}, map(step_of, (2.0, 3.0))
    first, again, turned = (
        module_of(called, steps) for steps in ([double, triple], [double, triple], [triple, double])
    )
    renamed = module_of({"other": called["called"]}, [double, triple])
    assert first == again and len({first, turned, renamed}) == len(made) == 3


@pytest.fixture
def step_of() -> Callable[[float], Any]:
    """Return a maker of blocks that multiply a signal by a factor."""
    from core.block import Block
    from core.ports import BlockPorts, output, reads

    def made(factor: float) -> Any:
        class Times(Block):
            class Ports(BlockPorts):
                given: float = reads("a.b", "1", "given")
                found: float = output("1", "found")

            @staticmethod
            def step(p: Any, s: Any, x: Any) -> None:
                x.found = factor * x.given

        return Times

    return made


def test_a_step_that_needs_a_function_of_the_system_is_refused_by_name(monkeypatch: pytest.MonkeyPatch):
    away = """
declare double @tgamma(double)
define void @"step"(ptr %p, ptr %s, ptr %w, ptr %io) {
  %x = load double, ptr %p
  %y = call double @tgamma(double %x)
  store double %y, ptr %s
  ret void
}"""

    monkeypatch.setattr(kernel_cache, "_shelves", [])
    monkeypatch.setattr(code, "translated", lambda *_: (away, True))
    from core.loop.guard import Guard

    with pytest.raises(InputError, match=r"guard calls tgamma, which no browser has"):
        module_of({}, [Guard])

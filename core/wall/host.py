"""The machine that runs WebAssembly: wasmtime, with nothing lent and a limit on all it can use.

An instance is one step in a memory of its own. A call fills this memory anew with the inputs of the step, so any
instance of a unit serves any board.
"""

from __future__ import annotations

import atexit
import ctypes
from dataclasses import dataclass, field
from functools import cache
from typing import Any

from core.errors import InputError

PAGE = 1 << 16
STACK_BYTES = 1 << 16
"""Stack of a step in its memory, behind the numbers: if it grows too far, it writes over these copies."""
HOST_STACK_BYTES = 1 << 18
MOST_BYTES = 4 << 20
"""Of a module, and of the memory of an instance."""
FUEL = 4_000_000
"""Instructions of a call: a sample has at most 50 000 operations, each of some instructions."""
INSTALL = "install wasmtime: pip install '.[wall]' in a checkout; or set units to teacher or off"


@dataclass(frozen=True)
class WalledInstance:
    """A step in a memory of its own, by addresses of this process.

    Attributes
    ----------
    context, function, stack : int
        Its store, the step, the place of its stack.
    memory : int
        Where its memory begins.
    room : int
        From where on memory is free.
    stack_top : int
        The place of the stack between calls.
    owners : tuple
        Objects that must live as long.
    """

    context: int
    function: int
    stack: int
    memory: int
    room: int
    stack_top: int
    owners: tuple[Any, ...] = field(repr=False)


@cache
def machine() -> Any:
    """Return the package that runs WebAssembly.

    Raises
    ------
    InputError
        When it is not there.
    """
    try:
        import wasmtime
    except (ImportError, OSError, RuntimeError) as error:
        raise InputError(f"the wall around units cannot be built: {error}", "units", INSTALL) from None
    return wasmtime


def function_address(name: str) -> int:
    """Return the address of a function of the machine."""
    machine()
    from wasmtime import _ffi  # the package has no other way to its C functions

    return int(ctypes.cast(getattr(_ffi.dll, name), ctypes.c_void_p).value or 0)


@cache
def _engine() -> Any:
    config = machine().Config()
    config.consume_fuel = True
    config.wasm_simd = config.wasm_relaxed_simd = config.wasm_threads = config.wasm_tail_call = False
    config.wasm_multi_memory = config.wasm_memory64 = False
    config.parallel_compilation = False
    config.max_wasm_stack = HOST_STACK_BYTES
    # instructions check all bounds, so there is no signal to handle and no address space to reserve
    config.signals_based_traps = config.memory_init_cow = False
    config.memory_reservation = config.memory_reservation_for_growth = config.memory_guard_size = 0
    return machine().Engine(config)


atexit.register(_engine.cache_clear)  # before the package that deletes it is unloaded


def module_of(code: bytes) -> Any:
    """Return the module in WebAssembly, once it is seen to ask for its memory and its stack alone.

    Raises
    ------
    InputError
        When it is larger, asks for more, or offers something else than a step.
    """
    wasmtime = machine()
    if len(code) > MOST_BYTES:
        raise InputError(f"has more than {MOST_BYTES >> 20} MB behind the wall")
    try:
        module = wasmtime.Module(_engine(), code)
    except wasmtime.WasmtimeError as error:
        raise InputError(f"is no WebAssembly: {str(error).splitlines()[0]}") from None
    lent = {"__linear_memory": wasmtime.MemoryType, "__stack_pointer": wasmtime.GlobalType}
    for one in module.imports:
        if one.module != "env" or one.name not in lent or not isinstance(one.type, lent[one.name]):
            raise InputError(f"asks for {one.module}.{one.name}, which is not there behind the wall")
    offered = [(one.name, _signature(one.type)) for one in module.exports]
    if sorted(offered) != [("room", "-> i32"), ("step", "i32 i32 i32 i32 ->")]:
        raise InputError("offers something else than a step")
    return module


def _signature(kind: Any) -> str:
    """Return the type of a function in a word; an empty text for anything else."""
    if not isinstance(kind, machine().FuncType):
        return ""
    return " ".join([*map(str, kind.params), "->", *map(str, kind.results)])


def instance_of(module: Any, numbers: int) -> WalledInstance:
    """Return an instance of a module that has been checked, with room for so many numbers.

    Raises
    ------
    InputError
        When it needs too much memory, or its memory cannot be as it asks.
    """
    wasmtime = machine()
    store = wasmtime.Store(_engine())
    store.set_fuel(FUEL)
    own = sum(one.type.limits.min for one in module.imports if one.name == "__linear_memory")
    pages = own + 1 + -(-(8 * numbers + STACK_BYTES) // PAGE)
    if pages * PAGE > MOST_BYTES:
        raise InputError(f"needs more than {MOST_BYTES >> 20} MB behind the wall")
    memory = wasmtime.Memory(store, wasmtime.MemoryType(wasmtime.Limits(pages, pages)))
    kind = wasmtime.GlobalType(wasmtime.ValType.i32(), mutable=True)
    stack = wasmtime.Global(store, kind, wasmtime.Val.i32(pages * PAGE))
    lent = {"__linear_memory": memory, "__stack_pointer": stack}
    try:
        instance = wasmtime.Instance(store, module, [lent[one.name] for one in module.imports])
        step, room = (instance.exports(store)[name] for name in ("step", "room"))
        free = int(room(store))
    except (wasmtime.WasmtimeError, wasmtime.Trap) as error:
        raise InputError(f"does not fit behind the wall: {str(error).splitlines()[0]}") from None
    if not 0 <= free <= (own + 1) * PAGE or free % 8:
        raise InputError("says of no place in its memory that it is free")
    return WalledInstance(
        context=_address(store._context()),
        function=ctypes.addressof(step._func),
        stack=ctypes.addressof(stack._global),
        memory=_address(memory.data_ptr(store)),
        room=free,
        stack_top=pages * PAGE,
        owners=(store, memory, stack, instance, step),
    )


def _address(pointer: Any) -> int:
    return int(ctypes.cast(pointer, ctypes.c_void_p).value or 0)

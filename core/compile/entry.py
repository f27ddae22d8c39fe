"""Kernels that Python calls: a function of its C interface takes numbers, arrays and records apart.

What Python gives is known by kinds: of a number its name, of an array its elements, dimensions and whether it is
without gaps, of a record its class. The function is written for these kinds alone; of other arguments it says that it
is not made for them. Records are the exception: it takes their addresses, and does not check their class.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from types import FunctionType
from typing import Any

import llvmlite.binding as llvm
import numpy as np
from llvmlite import ir

from core.compile.arrays import ELEMENTS, ArrayView, contiguous
from core.compile.code import Piece, compiler, digest, settled
from core.compile.machine import loaded
from core.compile.numbers import BOOL, DOUBLE, FLOAT, I64, INT, NAME, UINT, CompiledNumber, Unsupported, is_number
from core.compile.places import RecordView
from core.compile.translate import Translation
from core.kernel_cache import key
from core.record import Record

Kinds = tuple[Any, ...]

OBJECT = ir.IntType(8).as_pointer()
LONG = ir.IntType(8 * ctypes.sizeof(ctypes.c_long))
TYPE, DATA, DIMENSIONS, LENGTHS, STRIDES, ELEMENT, FLAGS = 8, 16, 24, 32, 40, 56, 64
"""Offsets of the type in an object of Python, and of the fields of an array of numpy."""
DENSE = 1
"""The flag of an array without gaps."""
C_INTERFACE: dict[str, tuple[Any, list[Any]]] = {
    "PyFloat_AsDouble": (DOUBLE, [OBJECT]),
    "PyLong_AsLongLong": (I64, [OBJECT]),
    "PyObject_IsTrue": (ir.IntType(32), [OBJECT]),
    "PyErr_Occurred": (OBJECT, []),
    "PyFloat_FromDouble": (OBJECT, [DOUBLE]),
    "PyLong_FromLongLong": (OBJECT, [I64]),
    "PyLong_FromUnsignedLongLong": (OBJECT, [I64]),
    "PyBool_FromLong": (OBJECT, [LONG]),
    "PyTuple_New": (OBJECT, [I64]),
    "PyTuple_SetItem": (ir.IntType(32), [OBJECT, I64, OBJECT]),
    "Py_IncRef": (ir.VoidType(), [OBJECT]),
    "PyEval_SaveThread": (OBJECT, []),
    "PyEval_RestoreThread": (ir.VoidType(), [OBJECT]),
}
NUMBERS: dict[type, str] = {float: "float64", int: "int64", bool: "bool"}
NUMBERS |= {np.float64: "float64", np.int64: "int64", np.bool_: "bool"}
DTYPES = {np.dtype(name): name for name in ELEMENTS}
FASTCALL = 0x80


class _Definition(ctypes.Structure):
    _fields_ = (
        ("name", ctypes.c_char_p),
        ("address", ctypes.c_void_p),
        ("flags", ctypes.c_int),
        ("text", ctypes.c_char_p),
    )


OBJECTS: dict[str, Any] = {"NotImplemented": NotImplemented, "ndarray": np.ndarray}
OBJECTS |= {f"type.{kind.__module__}.{kind.__name__}": kind for kind in NUMBERS}
OBJECTS |= {f"dtype.{name}": dtype for dtype, name in DTYPES.items()}
"""Objects that code compares with, by their addresses in this process."""

for _name in C_INTERFACE:
    llvm.add_symbol(_name, ctypes.cast(getattr(ctypes.pythonapi, _name), ctypes.c_void_p).value)
for _name, _object in OBJECTS.items():
    llvm.add_symbol(_name, id(_object))
_new = ctypes.pythonapi.PyCFunction_NewEx
_new.argtypes, _new.restype = [ctypes.POINTER(_Definition), ctypes.py_object, ctypes.py_object], ctypes.py_object
_keep = ctypes.pythonapi.Py_IncRef
_keep.argtypes, _keep.restype = [ctypes.py_object], None


def kind_of(value: Any) -> Any:
    """Return the kind of an argument.

    Raises
    ------
    TypeError
        When no kernel takes such a thing.
    """
    kind = NUMBERS.get(type(value))
    if kind is not None:
        return kind
    if isinstance(value, np.ndarray) and value.dtype in DTYPES:
        return DTYPES[value.dtype], value.ndim, value.flags.c_contiguous
    if isinstance(value, Record):
        return type(value)
    if isinstance(value, int | np.integer):
        return "int64"
    if isinstance(value, float | np.floating):
        return "float64"
    raise TypeError(f"no kernel takes {type(value).__name__} {value!r:.60}")


def plain(value: Any) -> Any:
    """Return an argument as the code that is made for its kind takes it."""
    kind = kind_of(value)
    if isinstance(value, np.ndarray):
        return value.view(np.ndarray).view(kind[0])  # of the one object there is for such elements
    return float(value) if kind == "float64" else int(value) if kind == "int64" else value


def made(function: FunctionType, kinds: Kinds) -> Callable[..., Any]:
    """Return what Python calls: the function compiled for arguments of some kinds."""
    address = loaded(piece(function, kinds).kept())
    definition = _Definition(function.__name__.encode(), address, FASTCALL, None)
    _keep(definition)  # never freed: an interpreter that ends reads it after the names of this module are dropped
    return _new(ctypes.byref(definition), None, None)  # type: ignore[no-any-return]


def piece(function: FunctionType, kinds: Kinds) -> Piece:
    """Return the code of a function for arguments of some kinds."""
    layouts = tuple(kind.layout if isinstance(kind, type) and issubclass(kind, Record) else kind for kind in kinds)
    return Piece(
        f"kernel-{function.__module__}.{function.__name__}",
        lambda content: digest(key(function, content), layouts, compiler()),
        lambda: instructions(function, kinds),
        loops=True,
    )


def instructions(function: FunctionType, kinds: Kinds) -> str:
    """Return the instructions of a function for arguments of some kinds."""
    return str(settled(lambda known: _written(function, kinds, known)))


def _written(function: FunctionType, kinds: Kinds, known: Any) -> tuple[ir.Module, bool]:
    module = ir.Module(NAME)
    entry = ir.Function(module, ir.FunctionType(OBJECT, [OBJECT, OBJECT.as_pointer(), I64]), NAME)
    builder = ir.IRBuilder(entry.append_basic_block("entry"))
    start = builder.append_basic_block("start")
    with builder.goto_block(start):
        translation = Translation(builder, known, 1, lanes=False)
        call = _Interface(builder, module)
        if not any(isinstance(kind, type) for kind in kinds):
            call.check(entry.args[1], entry.args[2], kinds)
        arguments = [call.taken(entry.args[1], i, kind, translation) for i, kind in enumerate(kinds)]
        call.stop_at_errors(kinds)
        # other threads run meanwhile where there may be much to do
        thread = call("PyEval_SaveThread") if any(isinstance(kind, tuple) for kind in kinds) else None
        result = translation.call(function, arguments)
        if thread is not None:
            call("PyEval_RestoreThread", thread)
        builder.ret(call.given(result, entry.args[0], translation))
    builder.branch(start)
    return module, translation.is_complete


class _Interface:
    """Writes calls of the C interface of Python."""

    def __init__(self, builder: ir.IRBuilder, module: ir.Module) -> None:
        self._build, self._module = builder, module

    def __call__(self, name: str, *arguments: Any) -> Any:
        result, takes = C_INTERFACE[name]
        function = self._module.globals.get(name) or ir.Function(self._module, ir.FunctionType(result, takes), name)
        return self._build.call(function, arguments)

    def object(self, name: str) -> Any:
        """Return the address of an object of Python."""
        known = self._module.globals.get(name)
        return known or ir.GlobalVariable(self._module, OBJECT.pointee, name)

    def at(self, given: Any, offset: int, kind: Any) -> Any:
        """Return the value at an offset in an object of Python."""
        place = self._build.gep(given, [ir.Constant(I64, offset)])
        return self._build.load(self._build.bitcast(place, kind.as_pointer()))

    def check(self, arguments: Any, count: Any, kinds: Sequence[Any]) -> None:
        """Say that the code is not made for arguments of other kinds."""
        build, none = self._build, self.object("NotImplemented")
        self._stop_unless(build.icmp_signed("==", count, ir.Constant(I64, len(kinds))), none)
        for i, kind in enumerate(kinds):
            given = build.load(build.gep(arguments, [ir.Constant(I64, i)]))
            found = self.at(given, TYPE, OBJECT)
            names = [f"type.{one.__module__}.{one.__name__}" for one, name in NUMBERS.items() if name == kind]
            right = [build.icmp_unsigned("==", found, self.object(name)) for name in names or ["ndarray"]]
            self._stop_unless(right[0] if len(right) == 1 else build.or_(*right), none)
            if not names:
                element, dimensions, is_dense = kind
                word = ir.IntType(32)
                of = build.icmp_unsigned("==", self.at(given, ELEMENT, OBJECT), self.object(f"dtype.{element}"))
                has = build.icmp_signed("==", self.at(given, DIMENSIONS, word), ir.Constant(word, dimensions))
                dense = build.and_(self.at(given, FLAGS, word), ir.Constant(word, DENSE))
                is_so = build.icmp_signed("==", dense, ir.Constant(word, DENSE if is_dense else 0))
                self._stop_unless(build.and_(build.and_(of, has), is_so), none)

    def _stop_unless(self, holds: Any, result: Any) -> None:
        with self._build.if_then(self._build.not_(holds), likely=False):
            self("Py_IncRef", result)
            self._build.ret(result)

    def taken(self, arguments: Any, place: int, kind: Any, translation: Translation) -> Any:
        """Return an argument as the translation sees it."""
        build = self._build
        given = build.load(build.gep(arguments, [ir.Constant(I64, place)]))
        if isinstance(kind, tuple):
            return self._array(given, kind, translation)
        if isinstance(kind, type) and issubclass(kind, Record):  # the address of its numbers
            return RecordView(build.inttoptr(self("PyLong_AsLongLong", given), DOUBLE.as_pointer()), None, kind.layout)
        if kind == "float64":
            return CompiledNumber(self("PyFloat_AsDouble", given), FLOAT)
        if kind == "bool":
            truth = self("PyObject_IsTrue", given)
            return CompiledNumber(build.icmp_signed("!=", truth, ir.Constant(truth.type, 0)), BOOL)
        return CompiledNumber(self("PyLong_AsLongLong", given), INT)

    def stop_at_errors(self, kinds: Sequence[Any]) -> None:
        """Raise the error of a conversion, such as a number that is too large."""
        if any(not isinstance(kind, tuple) for kind in kinds):
            wrong = self._build.icmp_unsigned("!=", self("PyErr_Occurred"), ir.Constant(OBJECT, None))
            with self._build.if_then(wrong, likely=False):
                self._build.ret(ir.Constant(OBJECT, None))

    def _array(self, given: Any, kind: tuple[str, int, bool], translation: Translation) -> ArrayView:
        build, (element, dimensions, is_dense) = self._build, kind

        def numbers(field: int) -> list[CompiledNumber]:
            where = self.at(given, field, I64.as_pointer())
            return [CompiledNumber(build.load(build.gep(where, [ir.Constant(I64, i)])), INT) for i in range(dimensions)]

        lengths = tuple(numbers(LENGTHS))
        strides = contiguous(translation.arithmetic, lengths)
        if not is_dense:
            size = ir.Constant(I64, np.dtype(element).itemsize)
            strides = tuple(CompiledNumber(build.sdiv(stride.value, size), INT) for stride in numbers(STRIDES))
        return ArrayView(self.at(given, DATA, ELEMENTS[element][0].as_pointer()), element, lengths, strides)

    def given(self, result: Any, none: Any, translation: Translation) -> Any:
        """Return a result as Python sees it."""
        if isinstance(result, tuple):
            several = self("PyTuple_New", ir.Constant(I64, len(result)))
            for i, part in enumerate(result):
                self("PyTuple_SetItem", several, ir.Constant(I64, i), self.given(part, none, translation))
            return several
        if result is None:
            self("Py_IncRef", none)
            return none
        if not is_number(result):
            raise Unsupported("a result that is no number")
        number = translation.arithmetic.number(result)
        if number.kind == BOOL:
            return self("PyBool_FromLong", self._build.zext(number.value, LONG))
        makers = {FLOAT: "PyFloat_FromDouble", INT: "PyLong_FromLongLong", UINT: "PyLong_FromUnsignedLongLong"}
        return self(makers[number.kind], number.value)

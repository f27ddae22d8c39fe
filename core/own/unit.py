"""A user unit: its text, checked, as a block like any other."""

from __future__ import annotations

import ast
import hashlib
import linecache
import math
import weakref
from collections.abc import Callable
from dataclasses import astuple, dataclass
from functools import lru_cache
from types import FunctionType
from typing import Any, cast

import numpy as np

from core.block import Block, BlockParams, Context, Equation, FloatArray, Stage
from core.cards import check_structure
from core.control.controller import EngagedPorts
from core.diagnose.hypothesis import BankParams
from core.diagnose.judge import Judge
from core.errors import InputError
from core.faults.fault import Fault
from core.identify.estimator import Estimator
from core.kernel import kernel
from core.own.declare import Declaration
from core.own.evaluate import Evaluator
from core.own.guarded import signed
from core.own.kinds import NOTHING, NUMBER, Kind, RecordKind, Signals, is_alike
from core.own.methods import FACTS, check_method
from core.own.mistakes import BROKEN, Mistakes, follows
from core.own.public import ALARMS, AXES, OBSERVED, check_ports, slot_of
from core.own.steps import OwnSteps
from core.own.text import UnitError, read, refuse
from core.own.values import Own
from core.ports import INPUT
from core.reference.waveform import Waveform
from core.registry import blocks
from core.sense.sensor import Sensor
from core.supervise.supervisor import Supervisor
from core.text import without_mark

BASES: tuple[tuple[type[Block], str], ...] = (
    (Waveform, "reference"),
    (Fault, "faults"),
    (Sensor, "sense"),
    (Judge, "diagnose"),
    (Estimator, "identify"),
    (Supervisor, "supervise"),
)
"""The family of a unit, by its base; a unit on ``Block`` with the ports of a controller is a controller."""

ATTRIBUTES = {
    **{"title": str, "equations": tuple, "structure": tuple, "weaknesses": tuple},
    **{"group": str, "place": int, "changes": str},
}
FAULT_ATTRIBUTES = {"shows": str, "suggested": float, "axes": type(None)}
LONGEST_TEXT = 2000
OF_BENCH = ("cls", "params", "context")
METHODS = {
    **dict.fromkeys(("pack", "state", "noise_um", "ambiguity_um"), OF_BENCH),
    "unsuited": ("cls", "device", "model"),
    **dict.fromkeys(("lines", "tone_hz"), ("cls", "params")),
}
ENTRIES = {"step": ("p", "s", "x"), "shape": ("p", "t")}
"""Methods that are compiled, and their arguments."""
RETURNED: dict[str, tuple[type[Any] | tuple[type[Any], ...], str]] = {
    "unsuited": (str, "a text"),
    "lines": (list, "a list of lines"),
    **dict.fromkeys(("noise_um", "ambiguity_um", "tone_hz"), ((int, float), "a number")),
}
RUN = {"__builtins__": {"range": range, "float": float, "int": int, "abs": abs, "min": min, "max": max}}
"""All names that the code of a step has besides the library names it uses."""


@dataclass(frozen=True)
class Unit:
    """A checked unit.

    Attributes
    ----------
    family, name, source : str
        Its family, its name, its text.
    block : type of Block
        The unit as the library would have it.
    operations : int
        Most operations of a sample.
    """

    family: str
    name: str
    source: str
    block: type[Block]
    operations: int

    @property
    def hash(self) -> str:
        """Identifier of its text."""
        return hashlib.sha256(self.source.encode()).hexdigest()


@lru_cache(maxsize=256)
def unit(name: str, source: str) -> Unit:
    """Check the text of a unit and return it.

    Raises
    ------
    UnitError
        Naming line and column.
    """
    source = without_mark(source)
    tree = read(source)
    mark = hashlib.sha256(source.encode()).hexdigest()[:12]
    mistakes = Mistakes()
    declared = Declaration(tree, f"core.own.{name}_{mark}", mistakes)
    if declared.node is None:
        mistakes.check()
    node = cast(ast.ClassDef, declared.node)
    space: dict[str, Any] = {**declared.inner, "text": source, "__doc__": declared.values["__doc__"]}
    family = ""
    with mistakes.apart():
        if "Ports" in declared.broken:
            raise follows(node)
        family = _family(declared)
        with mistakes.apart():
            check_ports(node, family, declared.inner.get("Ports", declared.base.Ports))
        space |= {**_attributes(declared, family), "__module__": f"own.{family}.{name}"}
    space |= _methods(declared, mistakes)
    steps = OwnSteps(declared.names, Judge.Packed if issubclass(declared.base, Judge) else None, mistakes)
    entry = "shape" if issubclass(declared.base, Waveform) else "step"
    method = declared.methods.get(entry)
    with mistakes.apart():
        if method is not None:
            _check_step(steps, declared, method, entry)
        elif getattr(declared.base, entry) is getattr(Block if entry == "step" else Waveform, entry):
            refuse(node, f"has no {entry}; write a static method {entry}({', '.join(ENTRIES[entry])})")
    for function in declared.names.values():
        if isinstance(function, ast.FunctionDef) and function.name not in steps.called:
            check_method(function, declared.names, mistakes, {})
    mistakes.check()
    if method is not None:
        made = _function(steps, entry, name, mark)
        space[entry] = staticmethod(kernel(made) if entry == "shape" else made)
    try:
        block = type(node.name, (declared.base,), space)
        check_structure(block)
        weakref.finalize(block, linecache.cache.pop, _file(name, mark), None)  # many texts are checked as one types
        own = Unit(family, name, source, block, steps.last_cost)
    except (TypeError, ValueError) as error:
        raise UnitError(f"cannot be declared: {error}", node.lineno, 1) from None
    return own


def _check_step(steps: OwnSteps, declared: Declaration, method: ast.FunctionDef, entry: str) -> None:
    """Check the step of a unit, or the shape of a reference; a table with errors of its own is left out."""
    packed, state = (declared.inner.get(name, getattr(declared.base, name)) for name in ("Packed", "State"))
    kinds: dict[str, Kind] = {
        "Packed": RecordKind(packed, False),
        "State": RecordKind(state, True),
        "Ports": Signals(declared.inner.get("Ports", declared.base.Ports)),
    }
    taken: list[Kind] = [BROKEN if name in declared.broken else kind for name, kind in kinds.items()]
    returned = steps.function(method, [taken[0], NUMBER] if entry == "shape" else taken, entry)
    if not is_alike(returned, NUMBER if entry == "shape" else NOTHING):
        refuse(method, "shape returns a number" if entry == "shape" else "step returns nothing; it writes outputs of x")


def _family(declared: Declaration) -> str:
    """Return the family of a unit."""
    for base, family in BASES:
        if issubclass(declared.base, base):
            return family
    ports = declared.inner.get("Ports", declared.base.Ports)
    if declared.base is Block and (issubclass(ports, EngagedPorts) or slot_of(ports)):
        return "control"
    sources = {port.source for port in ports.declared} - {*OBSERVED}
    if declared.base is Block and any(source.startswith("plant.") for source in sources):
        return "sense"
    if declared.base is Block and any(port.source == "@active.rate" for port in ports.declared):
        return "readout"
    if declared.base is Block and any(port.name in ALARMS and port.kind != INPUT for port in ports.declared):
        return "diagnose"
    node = cast(ast.ClassDef, declared.node)
    blocks = "ControllerPorts, DrivePorts or RatePorts, a Block that reads the plant or @active.rate, or puts out alarm"
    bases = ", ".join(base.__name__ for base, _ in BASES)
    return refuse(node, f"is none of these: a Block with {blocks}, or on one of {bases}")


def _attributes(declared: Declaration, family: str) -> dict[str, Any]:
    """Return the attributes of the class, each of its kind."""
    node = cast(ast.ClassDef, declared.node)
    slot = slot_of(declared.inner.get("Ports", declared.base.Ports))
    wanted = ({"axes": AXES} if slot or family == "readout" else {}) | ({"slot": slot} if slot else {})
    more = {name: type(value) for name, value in wanted.items()}
    allowed = ATTRIBUTES | more | (FAULT_ATTRIBUTES if family == "faults" else {})
    found = {name: value for name, value in declared.values.items() if name != "__doc__"}
    for name, value in found.items():
        if name not in allowed:
            refuse(node, f"{name} is no attribute of a unit; allowed: {', '.join(allowed)}")
        parts = value if isinstance(value, tuple) else (value,)
        inner = {"equations": Equation, "structure": Stage}.get(name, str)
        if not isinstance(value, allowed[name]) or (
            isinstance(value, tuple) and not all(type(p) is inner for p in parts)
        ):
            refuse(node, f"{name} must be {allowed[name].__name__}")
        for part in parts:
            texts = _texts(part) if isinstance(part, Equation | Stage) else (part,) if isinstance(part, str) else ()
            if any(not isinstance(text, str) or len(text) > LONGEST_TEXT for text in texts):
                refuse(node, f"{name} has a text of more than {LONGEST_TEXT} characters")
    for name, value in wanted.items():
        if found.get(name) != value:
            refuse(node, f"{name} must be {value!r} with these ports")
    shown = sorted({block.shows for block in blocks("faults").values()})
    if family == "faults" and found.get("shows") not in shown:
        refuse(node, f"shows must be one of {', '.join(shown)}")
    if not found.get("title") or len(found["title"]) > 80:
        refuse(node, "needs a title of at most 80 characters")
    return found


def _texts(part: Equation | Stage) -> list[Any]:
    """Return all texts of an equation or of a stage."""
    return [text for value in astuple(part) for text in (value if isinstance(value, tuple) else (value,))]


def _methods(declared: Declaration, mistakes: Mistakes) -> dict[str, Any]:
    """Return the methods that pack, begin and refuse, each worked out by walking its tree."""
    made: dict[str, Any] = {}
    params = declared.inner.get("Params", getattr(declared.base, "Params", BlockParams))
    facts = FACTS if "Params" in declared.broken else {**FACTS, "params": params.model_fields}
    for name, node in declared.methods.items():
        if name in ENTRIES:
            continue
        with mistakes.apart():
            if name not in METHODS:
                refuse(node, f"{name} is no method of a unit; allowed: {', '.join((*METHODS, *ENTRIES))}")
            if [argument.arg for argument in node.args.args] != list(METHODS[name]):
                refuse(node, f"{name} takes {', '.join(METHODS[name])}")
            check_method(node, declared.names, mistakes, facts)
            made[name] = classmethod(_worked_out(name, node, declared.names))
    made["packed"] = classmethod(_packed)
    return made


def _worked_out(name: str, node: ast.FunctionDef, names: dict[str, Any]) -> Callable[..., Any]:
    def method(cls: type[Block], *arguments: Any) -> Any:
        result = Evaluator(names).call(node, (Own(cls), *arguments), cls)
        packed = {"pack": (cls.Packed, "a Packed"), "state": (cls.State, "a State")}
        kind, words = (packed | RETURNED)[name]
        return result if isinstance(result, kind) else refuse(node, f"must return {words}")

    return method


def _packed(cls: type[Block], params: BlockParams, context: Context) -> FloatArray:
    """Return the numbers the step reads, once each of them is one."""
    try:
        numbers: FloatArray = cls.__mro__[1].packed.__func__(cls, params, context)  # type: ignore[attr-defined]
    except (TypeError, ValueError, ArithmeticError) as error:
        raise error if isinstance(error, InputError) else InputError(str(error)) from None
    if issubclass(cls, Judge):
        cls.Packed(numbers).count = cast(BankParams, params).count  # the number of loops, which the unit must not set
    if np.isnan(numbers).any():
        raise InputError("pack leaves a number that is none")
    return numbers


def _file(name: str, mark: str) -> str:
    """Return the file name for the source of a step."""
    return f"<unit {name} {mark}>"


def _function(steps: OwnSteps, entry: str, name: str, mark: str) -> FunctionType:
    """Return the checked functions as Python's own, to be compiled; nothing of them has run."""
    tree = ast.fix_missing_locations(ast.Module(list(steps.written), []))
    text = ast.unparse(tree)
    file = _file(name, mark)
    linecache.cache[file] = (
        len(text),
        None,
        text.splitlines(keepends=True),
        file,
    )  # for whatever reads the source again
    used = {**steps.used, "_sqrt": math.sqrt, "_copysign": signed, "_isfinite": math.isfinite}
    space: dict[str, Any] = {**RUN, **used, "__name__": "core.own"}
    exec(compile(text, file, "exec"), space)  # defines functions, calls none
    for written in steps.written[:-1]:
        space[written.name] = kernel(space[written.name])
    function: FunctionType = space[entry]
    return function

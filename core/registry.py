"""Finds blocks: the file is the unit, its name is the key, its folder the family."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from typing import Any, Literal, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from core.block import LOOP, Block, BlockParams, Equation
from core.errors import InputError, unknown
from core.ports import Port

FAMILIES = ("reference", "rate", "plant", "sense", "control", "identify", "diagnose", "readout", "faults", LOOP)


class PortCard(BaseModel):
    """A port as people see it."""

    name: str
    unit: str
    meaning: str
    labels: list[str]
    each: str


class ParameterCard(BaseModel):
    """A parameter as people see it."""

    name: str
    label: str
    type: str
    unit: str
    default: Any
    minimum: float | None
    maximum: float | None
    meaning: str
    equation: str
    live: bool
    choices: list[str]


class EquationCard(BaseModel):
    """An equation, with its erratum when the printed one is wrong."""

    label: str
    latex: str
    source: str
    printed: str | None
    why: str | None


class BlockCard(BaseModel):
    """All that the catalogue says of a block."""

    family: str
    name: str
    title: str
    group: str
    summary: str
    changes: str | None
    shows: str | None
    suggested: float | None
    weaknesses: list[str]
    axes: list[str] | None
    per_axis: bool
    slot: str
    equations: list[EquationCard]
    parameters: list[ParameterCard]
    inputs: list[PortCard]
    outputs: list[PortCard]
    taps: list[PortCard]
    schema_: dict[str, Any]


@cache
def blocks(family: str) -> dict[str, type[Block]]:
    """Return the blocks of a family by name, those of installed packages included, those that stand apart left out."""
    return {name: entry for name, entry in _all(family).items() if not entry.apart}


@cache
def apart(family: str) -> dict[str, type[Block]]:
    """Return the blocks of a family that no bench has unless something puts them there."""
    return {name: entry for name, entry in _all(family).items() if entry.apart}


@cache
def _all(family: str) -> dict[str, type[Block]]:
    """Return the blocks of a family by name.

    Other packages add blocks by an entry point of the group ``combbench.<family>`` that names the class.
    """
    if family not in FAMILIES:
        raise unknown("family", family, FAMILIES)
    folder = "core.loop" if family == LOOP else f"core.{family}"
    package = importlib.import_module(folder)
    found: dict[str, type[Block]] = {}
    for module_info in pkgutil.iter_modules(package.__path__):
        module = importlib.import_module(f"{folder}.{module_info.name}")
        for value in vars(module).values():
            if (
                isinstance(value, type)
                and issubclass(value, Block)
                and value.__module__ == module.__name__
                and hasattr(value, "title")  # the bases of families have none
            ):
                found[value.name] = value
    for entry in entry_points(group=f"combbench.{family}"):
        loaded = _installed(entry)
        loaded.name, loaded.family = entry.name, family
        found[entry.name] = loaded
    for loaded in found.values():
        _check_lengths(loaded)
    return dict(sorted(found.items()))


def _installed(entry: EntryPoint) -> type[Block]:
    """Return the block that an installed package names.

    Raises
    ------
    InputError
        When it cannot be loaded, or is no block.
    """
    package = entry.dist.name if entry.dist is not None else "an installed package"
    try:
        found = entry.load()
    except Exception as error:
        text = f"{package} names {entry.value}, which cannot be loaded: {error}"
        raise InputError(text, f"{entry.group}.{entry.name}") from None
    if not (isinstance(found, type) and issubclass(found, Block)):
        raise InputError(f"{package} names {entry.value}, which is no Block", f"{entry.group}.{entry.name}")
    return found


def _check_lengths(entry: type[Block]) -> None:
    """Refuse a block whose state could change its length while the board runs.

    Raises
    ------
    TypeError
        When the parameters that set the length are not named, not there, or tunable while running.
    """
    if entry.State.layout.tails and not entry.lengths:
        raise TypeError(f"{entry.__module__}: the state has a tail; name the parameters of its length in lengths")
    for name in entry.lengths:
        info = entry.Params.model_fields.get(name)
        if info is None or is_live(info):
            raise TypeError(f"{entry.__module__}: {name} sets the length of the state, so it must be there, live=False")


def block(family: str, name: object, field: str = "") -> type[Block]:
    """Return one block.

    Raises
    ------
    InputError
        When the family has no block of that name.
    """
    known = blocks(family)
    if isinstance(name, str) and name in apart(family):
        return apart(family)[name]
    if not isinstance(name, str) or name not in known:
        words = {
            "reference": "reference",
            "rate": "angular rate",
            "plant": "plant model",
            "sense": "sensor",
            "control": "controller",
            "identify": "identifier",
            "diagnose": "diagnoser",
            "readout": "read-out",
            "faults": "fault",
        }
        raise unknown(words.get(family, family), name, known, field)
    return known[name]


def catalog(family: str | None = None) -> list[BlockCard]:
    """Return the cards of one family, or of all, in the order in which people are shown them."""
    chosen = FAMILIES if family is None else (family,)
    return [card(entry) for name in chosen for entry in sorted(blocks(name).values(), key=lambda b: b.place)]


def equation_card(e: Equation) -> EquationCard:
    """Return an equation as people see it."""
    return EquationCard(label=e.label, latex=e.latex, source=e.source, printed=e.printed or None, why=e.why or None)


def parameter_cards(params: type[BlockParams]) -> list[ParameterCard]:
    """Return the parameters of a table as people see them."""
    return [_parameter(name, info) for name, info in params.model_fields.items()]


def card(entry: type[Block]) -> BlockCard:
    """Return the card of a block."""
    return BlockCard(
        family=entry.family,
        name=entry.name,
        title=entry.title,
        group=entry.group,
        summary=" ".join((entry.__doc__ or "").strip().split("\n\n")[0].split()),
        changes=entry.changes or None,
        shows=entry.shows or None,
        suggested=entry.suggested,
        weaknesses=list(entry.weaknesses),
        axes=None if entry.axes is None else list(entry.axes),
        per_axis=entry.per_axis,
        slot=entry.slot,
        equations=[equation_card(equation) for equation in entry.equations],
        parameters=parameter_cards(entry.Params),
        inputs=[_port(port) for port in entry.inputs],
        outputs=[_port(port) for port in entry.outputs],
        taps=[_port(port) for port in entry.taps],
        schema_=entry.Params.model_json_schema(),
    )


def is_live(info: FieldInfo) -> bool:
    """Say whether a parameter may change while the board runs."""
    extra = info.json_schema_extra
    return bool(extra.get("live", True)) if isinstance(extra, dict) else True


def _port(port: Port) -> PortCard:
    return PortCard(name=port.name, unit=port.unit, meaning=port.meaning, labels=list(port.labels), each=port.each)


def _parameter(name: str, info: FieldInfo) -> ParameterCard:
    extra = info.json_schema_extra if isinstance(info.json_schema_extra, dict) else {}
    limits: dict[str, float] = {}
    for constraint in info.metadata:
        for key in ("ge", "gt", "le", "lt"):
            value = getattr(constraint, key, None)
            if value is not None:
                limits[key] = float(value)
    default = info.get_default(call_default_factory=True)
    if isinstance(default, BaseModel):
        default = default.model_dump()
    elif isinstance(default, list):
        default = [item.model_dump() if isinstance(item, BaseModel) else item for item in default]
    kind, choices = _type(info.annotation)
    return ParameterCard(
        name=name,
        label=name.replace("_", " "),
        type=kind,
        unit=str(extra.get("unit", "")),
        default=default,
        minimum=limits.get("ge", limits.get("gt")),
        maximum=limits.get("le", limits.get("lt")),
        meaning=info.description or "",
        equation=str(extra.get("equation", "")),
        live=is_live(info),
        choices=choices,
    )


def _type(annotation: Any) -> tuple[str, list[str]]:
    if get_origin(annotation) is Literal:
        return "choice", [str(choice) for choice in get_args(annotation)]
    if get_origin(annotation) is list:
        return "list", []
    options = [option for option in get_args(annotation) if option is not type(None)] or [annotation]
    simple = {bool: "boolean", int: "integer", float: "number", str: "text"}
    for option in options:
        if option in simple:
            return simple[option], []
    return "table", []

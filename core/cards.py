"""Cards: descriptions of a block in catalogue, documents and forms."""

from __future__ import annotations

from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from core.block import Block, BlockParams, Equation, Stage
from core.ports import INPUT, Port
from core.table import Words


class PortCard(BaseModel):
    """A port as people see it."""

    name: str
    unit: str
    meaning: Words
    source: str
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
    meaning: Words
    equation: str
    live: bool
    choices: list[str]


class EquationCard(BaseModel):
    """An equation, with its erratum when the printed one is wrong."""

    label: str
    latex: str
    source: Words
    printed: str | None
    why: Words | None


class StageCard(BaseModel):
    """A visible stage of a block: its inputs and outputs by the names of ports and states."""

    title: str
    takes: list[str]
    gives: list[str]
    equations: list[EquationCard]


class BlockCard(BaseModel):
    """The catalogue entry of a block."""

    family: str
    name: str
    title: str
    group: str
    summary: Words
    changes: str | None
    shows: str | None
    suggested: float | None
    weaknesses: list[Words]
    axes: list[str] | None
    per_axis: bool
    slot: str
    equations: list[EquationCard]
    structure: list[StageCard]
    parameters: list[ParameterCard]
    inputs: list[PortCard]
    outputs: list[PortCard]
    taps: list[PortCard]
    schema_: dict[str, Any]


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
        structure=_structure(entry),
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


def check_structure(entry: type[Block]) -> None:
    """Refuse stages with unknown names, or stages that leave out an output or an equation of the block.

    Raises
    ------
    TypeError
        Naming the stage.
    """
    if not entry.structure:
        return
    labels, given = _labelled(entry), set[str]()
    inputs, outputs = ({p.name for p in ports if not p.hidden} for ports in (entry.inputs, entry.outputs))
    known = {port.name for port in entry.Ports.declared} | {field.name for field in entry.State.layout.fields}
    for stage in entry.structure:
        here = f"{entry.__module__}: {stage.title}"
        for name in f"{stage.takes} {stage.gives}".split():
            if name not in known:
                raise TypeError(f"{here} names {name}, which is no port and no state")
        for label in stage.equations:
            if label not in labels:
                raise TypeError(f"{here} names the equation {label}, which is not there")
        if twice := (given | inputs) & {*stage.gives.split()}:
            raise TypeError(f"{here} gives {min(twice)}, which comes from elsewhere")
        given |= {*stage.gives.split()}
    taken = {name for stage in entry.structure for name in stage.takes.split()}
    told = {label for stage in entry.structure for label in stage.equations}
    left = (taken - inputs - given) | (outputs - given) | ({e.label for e in entry.equations} - told)
    if left:
        raise TypeError(f"{entry.__module__}: no stage gives or carries {min(left)}")


def _labelled(entry: type[Block]) -> dict[str, Equation]:
    """Return the equations of a block and of its bases by label."""
    return {e.label: e for base in reversed(entry.__mro__) for e in vars(base).get("equations", ())}


def _structure(entry: type[Block]) -> list[StageCard]:
    """Return the stages of a block; a block without declared stages is a single stage with all of its ports."""
    labelled = _labelled(entry)
    visible = [port for port in entry.Ports.declared if not port.hidden]
    inputs, others = ([p.name for p in visible if (p.kind == INPUT) is taken] for taken in (True, False))
    whole = Stage(entry.title, " ".join(inputs), " ".join(others), tuple(e.label for e in entry.equations))
    return [
        StageCard(
            title=stage.title,
            takes=stage.takes.split(),
            gives=stage.gives.split(),
            equations=[equation_card(labelled[label]) for label in stage.equations],
        )
        for stage in entry.structure or (whole,)
    ]


def _port(port: Port) -> PortCard:
    return PortCard(
        name=port.name,
        unit=port.unit,
        meaning=port.meaning,
        source=port.source,
        labels=list(port.labels),
        each=port.each,
    )


def _parameter(name: str, info: FieldInfo) -> ParameterCard:
    extra = info.json_schema_extra if isinstance(info.json_schema_extra, dict) else {}
    limits: dict[str, float] = {}
    for constraint in _constraints(info):
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


def _choices(annotation: Any) -> list[Any]:
    """Return the types that a value may have besides none."""
    is_one_of = get_origin(annotation) in (Union, UnionType)
    return [one for one in get_args(annotation) if one is not type(None)] if is_one_of else [annotation]


def _constraints(info: FieldInfo) -> list[Any]:
    """Return the limits of a parameter, also where it may be none besides."""
    inner = [meta for one in _choices(info.annotation) if get_origin(one) is Annotated for meta in get_args(one)[1:]]
    return [*info.metadata, *(limit for meta in inner if isinstance(meta, FieldInfo) for limit in meta.metadata)]


def _type(annotation: Any) -> tuple[str, list[str]]:
    simple = {bool: "boolean", int: "integer", float: "number", str: "text", list: "list"}
    for one in _choices(annotation):
        bare = get_args(one)[0] if get_origin(one) is Annotated else one
        if get_origin(bare) is Literal:
            return "choice", [str(choice) for choice in get_args(bare)]
        if (kind := simple.get(get_origin(bare) or bare)) is not None:
            return kind, []
    return "table", []

"""Checks a document: validated blocks out, or the first thing that is not allowed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from pydantic import BaseModel, ValidationError

from core import registry
from core.block import Block, BlockParams, Oscillator
from core.board.document import (
    IDENTIFIER,
    SECTIONS,
    Document,
    as_written,
    completed,
    normal_form,
    written,
    written_over,
)
from core.board.instances import feeds_forward, instances
from core.board.spec import FIELDS, OF_CONTEXT, Frame, Section, Spec
from core.device.catalogue import device as build_device
from core.device.device import Device
from core.device.transfer_function import slowest_pole
from core.errors import InputError, from_validation, short
from core.loop.drive import Drive
from core.loop.environment import Environment
from core.loop.guard import Guard
from core.loop.model import Model
from core.plant.shuttle import ShuttleParams
from core.signals import CLOCK

MOST_GROWTH = 100.0
"""Exponent of what may grow within a sample: the cube of it is still a number."""


def parse(document: Document) -> Spec:
    """Check a document and return the bench it describes.

    Raises
    ------
    InputError
        For the first thing that is not allowed, with the dotted path of its field.
    """
    doc = normal_form(document)
    try:
        return _parse(doc, None)
    except InputError as error:
        raise as_written(error, document, written(document)) from None


def changed(spec: Spec, values: dict[str, Any]) -> Spec:
    """Return a bench with dotted paths written over; sections that stay as they are are not checked again.

    Raises
    ------
    InputError
        As ``parse``.
    """
    document = written_over(spec.document, values)
    try:
        new = _parse(completed(document), spec)
    except InputError as error:
        raise as_written(error, document, written(document)) from None
    if all(getattr(new, name) is getattr(spec, name) for name in OF_CONTEXT):
        vars(new)["_contexts"] = spec._contexts
    return new


def _parse(doc: Document, before: Spec | None) -> Spec:
    """Check a document in normal form; sections whose tables are those of another bench are taken from there."""
    known = before.document if before is not None else {}

    def same(*keys: str) -> bool:
        return before is not None and all(doc.get(key) is known.get(key) for key in keys)

    loose = [key for key in doc if key not in SECTIONS]
    if before is not None and same(*loose) and loose == [key for key in known if key not in SECTIONS]:
        frame = before.frame
    else:
        frame = _frame({key: doc[key] for key in loose})
    identifiers, diagnosers = doc.get("identifiers", {}), doc.get("diagnosers", {})
    for name in identifiers:
        if name in diagnosers:
            raise InputError("is the name of a diagnoser as well", f"identifiers.{name}", "choose another")
    if before is not None and same("device", "plant", "drive"):
        device, plant, drive = before.device, before.plant, before.drive
    else:
        device, plant, drive = _driven(doc, before if same("device") else None)

    def alone(key: str, block: type[Block]) -> Section:
        kept: Section | None = getattr(before, key) if same(key) else None
        return kept or Section(block, _params(block, doc.get(key, {}), key))

    def all_of(key: str, family: str) -> dict[str, Section]:
        kept: dict[str, Section] = getattr(before, key, {})
        if same(key) and same("device", "plant", "model"):
            return kept
        tables, old = doc.get(key, {}), known.get(key, {})
        for name in tables:
            registry.block(family, name, key)
        return {
            name: kept[name]
            if name in kept and tables.get(name) is old.get(name)
            else _section(family, name, tables.get(name, {}), f"{key}.{name}")
            for name in registry.blocks(family)
        }

    def chosen(key: str, family: str) -> dict[str, Section]:
        kept: dict[str, Section] = getattr(before, key, {})
        tables, old = doc.get(key, {}), known.get(key, {})
        return {
            name: kept[name] if table is old.get(name) else _named(family, key, name, table)
            for name, table in tables.items()
        }

    spec = Spec(
        document=doc,
        faults=before.faults if before is not None else {},
        frame=frame,
        device=device,
        environment=alone("environment", Environment),
        plant=plant,
        reference=before.reference
        if before is not None and same("reference")
        else _chosen("reference", doc["reference"], "reference"),
        model=alone("model", Model),
        drive=drive,
        guard=alone("guard", Guard),
        measuring=_measuring(doc["sensor"]["kind"]),
        sensors=all_of("sensors", "sense"),
        active=registry.block("control", doc["controller"]["kind"], "controller.kind").name,
        controllers=all_of("controllers", "control"),
        identifiers=chosen("identifiers", "identify"),
        diagnosers=chosen("diagnosers", "diagnose"),
    )
    if before is not None and spec.device is before.device:
        vars(spec)["nominal"] = before.nominal
    if before is None or [*before.identifiers, *before.diagnosers] != [*identifiers, *diagnosers]:
        _named_apart(spec)
    return _suited(spec)


def _driven(doc: Document, before: Spec | None) -> tuple[Device, Section, Section]:
    """Return device, plant and drive: how the drive works may be said at the plant, and a gap there is the device's."""
    plant = dict(doc["plant"])
    drive = dict(doc.get("drive", {}))
    if "drive" in plant:
        here, there = plant.pop("drive"), drive.get("kind")
        if drive.setdefault("kind", here) != here:
            text = f"plant.drive says {short(here)} and drive.kind {short(there)}"
            raise InputError(text, "drive.kind", "leave one of them out")
    device = build_device(doc["device"])
    usual = "transfer_function" if device.transfer_function is not None else "linear"
    if "model" not in plant:
        doc["plant"] = {**doc["plant"], "model": usual}
    section = _section("plant", plant.pop("model", usual), plant, "plant", "model")
    gap = section.params.gap_um if isinstance(section.params, ShuttleParams) else None
    if gap is not None:  # one comb, one gap: of the force, of the sensors, of the model a diagnoser believes in
        device = device.model_copy(update={"finger_gap_um": gap})
    if before is not None and before.device == device:
        device = before.device
    return device, section, Section(Drive, _params(Drive, drive, "drive"))


def _named_apart(spec: Spec) -> None:
    """Refuse identifiers and diagnosers by the name of another block: signals of both would have the same names."""
    chosen = [(key, name) for key in ("identifiers", "diagnosers") for name in getattr(spec, key)]
    others = instances(replace(spec, identifiers={}, diagnosers={})) if chosen else []
    taken = {*CLOCK, *(other.prefix.split(".")[0] for other in others)}
    for key, name in chosen:
        if name in taken:
            text = f"is the name of a part of the bench; taken: {', '.join(sorted(taken))}"
            raise InputError(text, f"{key}.{name}", "choose another name")


def _suited(spec: Spec) -> Spec:
    """Leave out controllers and sensors that are not for this device; refuse what was asked for and is not."""
    nominal = spec.nominal
    pair = nominal, Model.oscillator(spec.model.params, nominal)
    for path, grows in zip(("device.transfer_function", "model.denominator"), pair, strict=True):
        if slowest_pole(grows) * spec.dt_ms > MOST_GROWTH:
            text = f"grows by more than e^{MOST_GROWTH:g} from one sample to the next"
            raise InputError(text, path, "sample faster, or slow it down")
    fields = {
        "plant.model": spec.plant.block,
        "controller.kind": spec.controllers[spec.active].block,
        "sensor.kind": spec.sensors[spec.measuring].block,
    }
    if spec.is_analogue and not feeds_forward(spec.controllers[spec.active].block):
        able = " or ".join(name for name, block in registry.blocks("control").items() if feeds_forward(block))
        text = f"analogue is for {able} only: what {spec.active} asks for is held over a sample"
        raise InputError(text, "drive.kind", f"hold the drive, or let {able} drive")
    for key in ("identifiers", "diagnosers"):
        fields |= {f"{key}.{name}.kind": section.block for name, section in getattr(spec, key).items()}
    for path, block in fields.items():
        reason = block.unsuited(*pair)
        if reason:
            raise InputError(f"{block.name}: {reason}", path)
    controllers, sensors = _for(pair, spec.controllers), _for(pair, spec.sensors)
    if controllers is spec.controllers and sensors is spec.sensors:
        return spec
    return replace(spec, controllers=controllers, sensors=sensors)


def _for(pair: tuple[Oscillator, Oscillator], sections: dict[str, Section]) -> dict[str, Section]:
    suited = {name: section for name, section in sections.items() if not section.block.unsuited(*pair)}
    return sections if len(suited) == len(sections) else suited


def _frame(values: Document) -> Frame:
    try:
        return Frame.model_validate(values)
    except ValidationError as error:
        raise from_validation(error, {"": FIELDS}) from None


def _chosen(family: str, table: Document, field: str) -> Section:
    rest = dict(table)
    kind = rest.pop("kind", None)
    return _section(family, kind, rest, field)


def _section(family: str, kind: object, table: Document, field: str, key: str = "kind") -> Section:
    block = registry.block(family, kind, f"{field}.{key}")
    rest = dict(table)
    every = rest.pop("every", 1)
    if not isinstance(every, int) or isinstance(every, bool) or not 1 <= every <= 10000:
        raise InputError(f"must be a whole number from 1 to 10000, got {short(every)}", f"{field}.every")
    return Section(block, _params(block, rest, field), every)


def _measuring(kind: object) -> str:
    block = registry.block("sense", kind, "sensor.kind")
    if all(port.name != "displacement" for port in block.outputs):
        raise InputError(f"{block.name} puts out no displacement; choose a unit that recovers one", "sensor.kind")
    return block.name


def _named(family: str, key: str, name: str, table: Document) -> Section:
    if not IDENTIFIER.match(name):
        raise InputError("must be a short name of small letters, digits and _", f"{key}.{name}")
    return _chosen(family, table, f"{key}.{name}")


def _params(block: type[Block], values: Document, field: str) -> BlockParams:
    try:
        return block.Params.model_validate(values, strict=False)
    except ValidationError as error:
        raise from_validation(error, _nested_fields(block.Params)).under(field) from None


def _nested_fields(model: type[BaseModel]) -> dict[str, list[str]]:
    return {"": list(model.model_fields)}

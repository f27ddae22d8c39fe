"""Checks a document: validated blocks out, or the first thing that is not allowed."""

from __future__ import annotations

import copy
from dataclasses import replace
from typing import Any

from pydantic import BaseModel, ValidationError

from core.block import Block, BlockParams
from core.board.document import (
    CHOSEN,
    PARKED,
    SILENT,
    SUPERVISOR,
    Document,
    as_written,
    completed,
    normal_form,
    says_the_same,
    sections,
    written,
    written_over,
)
from core.board.fitting import driving, refuse_what_does_not_fit, suited
from core.board.instances import instances
from core.board.library import IDENTIFIER, Library, library_of
from core.board.spec import OF_CONTEXT, BoardSettings, Section, Spec, fields
from core.board.stages import STAGES, AxesBoardParams, BoardParams
from core.converter import twice_given
from core.device.catalogue import device as build_device
from core.device.device import Device
from core.errors import InputError, from_validation, short
from core.loop.amplifier import Amplifier
from core.loop.axis_amplifier import AxisAmplifier
from core.loop.axis_drive import AxisDrive
from core.loop.axis_guard import AxisGuard
from core.loop.drive import Drive
from core.loop.environment import Environment
from core.loop.guard import Guard
from core.loop.model import Model
from core.loop.record_drive import RecordDrive
from core.loop.record_guard import RecordGuard
from core.plant.record import RecordPlant
from core.plant.shuttle import ShuttleParams
from core.registry import apart
from core.signals import CLOCK


def parse(document: Document, like: Spec | None = None) -> Spec:
    """Check a document and return the bench it describes.

    Parameters
    ----------
    document : dict
        The tables of the bench.
    like : Spec, optional
        A bench without faults that may be alike: sections that both have are taken from there.

    Raises
    ------
    InputError
        For the first thing that is not allowed, with the dotted path of its field.
    """
    doc = normal_form(document) if like is None else _sharing(completed(document), like.document)
    try:
        spec = _parse(doc, like)
        _refuse_apart(spec)
    except InputError as error:
        raise as_written(error, document, written(document)) from None
    return spec


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
    if all(getattr(new, name) is getattr(spec, name) for name in OF_CONTEXT) and new.partner == spec.partner:
        vars(new)["_contexts"] = spec._contexts
    return new


def _sharing(doc: Document, other: Document) -> Document:
    """Return a copy of a document; it shares the tables of another document where both say the same."""

    def shared(value: Any, known: Any) -> Any:
        return known if says_the_same(value, known) else copy.deepcopy(value)

    def table(value: Any, known: Any) -> Any:
        if says_the_same(value, known) or not (isinstance(value, dict) and isinstance(known, dict)):
            return shared(value, known)
        return {key: shared(entry, known.get(key)) for key, entry in value.items()}

    return {key: table(value, other.get(key)) for key, value in doc.items()}


def _parse(doc: Document, before: Spec | None) -> Spec:
    """Check a document in normal form; sections whose tables are shared with another bench are taken from there."""
    library = library_of(doc)
    if before is not None and before.library is not library:
        before = None  # a name may mean another block
    known = before.document if before is not None else {}
    differing = {key for key in (*doc, *known) if doc.get(key) is not known.get(key)}

    def same(*keys: str) -> bool:
        return before is not None and differing.isdisjoint(keys)

    tables = sections()
    loose = [key for key in doc if key not in tables]
    if before is not None and same(*loose) and loose == [key for key in known if key not in tables]:
        frame = before.frame
    else:
        frame = _frame({key: doc[key] for key in loose})
    named = [(key, name) for key in CHOSEN for name in doc.get(key, {})]
    if len({name for _, name in named}) < len(named):
        _refuse_twice(named)
    if before is not None and same("device", "plant", "drive"):
        device, plant, drive = before.device, before.plant, before.drive
    else:
        device = build_device(doc["device"])
        known_parts = (before.plant, before.drive) if before is not None and same("plant", "drive") else None
        plant, drive = known_parts or _driven(library, doc, device)
        device = _fitted(device, plant)
        if before is not None and same("device") and before.device == device:
            device = before.device
    axes = plant.block.axes or ()
    in_use = (doc["controller"]["kind"], doc["sensor"]["kind"], *doc.get("slots", {}).values())
    refuse_what_does_not_fit(doc, plant.block)

    def alone(key: str, block: type[Block], params: type[BlockParams] | None = None) -> Section:
        kept: Section | None = getattr(before, key) if same(key) else None
        return kept or Section(block, _params(params or block.Params, doc.get(key, {}), key))

    def all_of(key: str, family: str) -> dict[str, Section]:
        kept: dict[str, Section] = before.offered.get(key, {}) if before is not None else {}
        if kept and same(key, "plant", "slots", *PARKED):
            return kept
        tables, old = doc.get(key, {}), known.get(key, {})
        for name in tables:
            library.block(family, name, key)
        return {
            name: kept[name]
            if name in kept and tables.get(name) is old.get(name)
            else _section(library, family, name, tables.get(name, {}), f"{key}.{name}")
            for name, block in (library.blocks(family) | apart(family)).items()
            if (block.fits(axes) and not block.apart) or name in tables or name in in_use
        }

    def generator(key: str, family: str) -> Section:
        if before is not None and same(key) and key in before.generators:
            return before.generators[key]
        return _chosen(library, family, doc[key], key)

    def chosen(key: str, family: str) -> dict[str, Section]:
        kept: dict[str, Section] = getattr(before, key, {})
        tables, old = doc.get(key, {}), known.get(key, {})
        return {
            name: kept[name] if table is old.get(name) else _named(library, family, key, name, table)
            for name, table in tables.items()
        }

    def supervisors() -> dict[str, Section]:
        if before is not None and same(SUPERVISOR):
            return before.supervisors
        return {SUPERVISOR: _supervising(library, doc[SUPERVISOR])} if SUPERVISOR in doc else {}

    offered = {"sensors": all_of("sensors", "sense"), "controllers": all_of("controllers", "control")}
    suiting = dict(offered)
    if before is not None and same("device", "plant", "model"):
        suiting |= {key: getattr(before, key) for key in offered if offered[key] is before.offered.get(key)}
    spec = Spec(
        document=doc,
        faults=before.faults if before is not None else {},
        frame=frame,
        device=device,
        environment=alone("environment", Environment),
        plant=plant,
        reference=before.reference if before is not None and same("reference") else _reference(library, doc),
        model=alone("model", Model),
        drive=drive,
        board=alone("board", AxisAmplifier, AxesBoardParams) if axes else alone("board", Amplifier, BoardParams),
        guard=alone("guard", AxisGuard if axes else RecordGuard if plant.block is RecordPlant else Guard),
        measuring=_measuring(library, doc["sensor"]["kind"]),
        sensors=suiting["sensors"],
        driving=driving(doc, plant.block),
        generators={key: generator(key, family) for key, family in plant.block.generators.items()},
        controllers=suiting["controllers"],
        offered=offered,
        supervisors=supervisors(),
        **{key: chosen(key, family) for key, family in CHOSEN.items()},
    )
    if before is not None and spec.device is before.device:
        vars(spec)["nominal"] = before.nominal
    if before is None or [(key, name) for key in CHOSEN for name in getattr(before, key)] != named:
        _named_apart(spec)
    return _recorded(suited(spec))


def _refuse_apart(spec: Spec) -> None:
    """Refuse a block that is computed outside of the bench (``apart``), because a scenario cannot name it."""
    text = "{} is computed outside of the bench, so no scenario can name it"
    for name, section in spec.controllers.items():
        if section.block.apart:
            field = "controller.kind" if name in spec.driving.values() else f"controllers.{name}"
            hint = "combbench run --controller-process, or combbench.run(..., law=...)"
            raise InputError(text.format(name), field, hint)
    for key in ("identifiers", "diagnosers"):
        for name, section in getattr(spec, key).items():
            if section.block.apart:
                hint = f"combbench.run(..., {key}={{...}})"
                raise InputError(text.format(section.block.name), f"{key}.{name}.kind", hint)


def _driven(library: Library, doc: Document, device: Device) -> tuple[Section, Section]:
    """Return plant and drive: the plant may give the kind of drive."""
    plant = dict(doc["plant"])
    drive = dict(doc.get("drive", {}))
    if "drive" in plant:
        here, there = plant.pop("drive"), drive.get("kind")
        if drive.setdefault("kind", here) != here:
            text = f"plant.drive says {short(here)} and drive.kind {short(there)}"
            raise InputError(text, "drive.kind", "leave one of them out")
    if "model" not in plant:
        doc["plant"] = {**doc["plant"], "model": device.usual_plant}
    section = _section(library, "plant", plant.pop("model", device.usual_plant), plant, "plant", "model")
    stage = AxisDrive if section.block.axes else RecordDrive if section.block is RecordPlant else Drive
    return section, Section(stage, _params(stage.Params, drive, "drive"))


def _recorded(spec: Spec) -> Spec:
    """Refuse a rate that is not the rate of the record, where the plant is one."""
    record = spec.record
    if record is not None and record.rate_khz != spec.frame.sample_rate_khz:
        text = f"is {short(spec.frame.sample_rate_khz)}, but the record has {record.rate_khz!r} samples for each ms"
        raise InputError(text, "sample_rate_khz", f"sample_rate_khz = {record.rate_khz!r}")
    return spec


def _fitted(device: Device, plant: Section) -> Device:
    """Return a device with the gap of its plant, if that has one."""
    gap = plant.params.gap_um if isinstance(plant.params, ShuttleParams) else None
    # one comb, one gap: of the force, of the sensors, of the model a diagnoser believes in
    return device if gap is None else device.model_copy(update={"finger_gap_um": gap})


def _reference(library: Library, doc: Document) -> Section:
    """Return the reference; where a bench has none, a reference that does nothing."""
    return _chosen(library, "reference", doc.get("reference", SILENT), "reference")


def _refuse_twice(named: list[tuple[str, str]]) -> None:
    """Refuse the first name that another table has as well."""
    tables = {name: key for key, name in named}
    key, name = next((key, name) for key, name in named if tables[name] != key)
    raise InputError(f"is a name of {tables[name]} as well", f"{key}.{name}", "choose another")


def _named_apart(spec: Spec) -> None:
    """Refuse names of the bench's own that another block has too: signals of both would have the same names."""
    chosen = [(key, name) for key in CHOSEN for name in getattr(spec, key)]
    nothing: dict[str, Any] = {key: {} for key in CHOSEN}
    others = instances(replace(spec, **nothing)) if chosen else []
    taken = {*CLOCK, *STAGES, *(other.prefix.split(".")[0] for other in others)}
    for key, name in chosen:
        if name in taken:
            text = f"is the name of a part of the bench; taken: {', '.join(sorted(taken))}"
            raise InputError(text, f"{key}.{name}", "choose another name")


def _frame(values: Document) -> BoardSettings:
    try:
        return BoardSettings.model_validate(values)
    except ValidationError as error:
        raise from_validation(error, {"": fields()}) from None


def _chosen(library: Library, family: str, table: Document, field: str) -> Section:
    rest = dict(table)
    kind = rest.pop("kind", None)
    return _section(library, family, kind, rest, field)


def _section(library: Library, family: str, kind: object, table: Document, field: str, key: str = "kind") -> Section:
    block = library.block(family, kind, f"{field}.{key}")
    rest = dict(table)
    every = rest.pop("every", 1)
    if not isinstance(every, int) or isinstance(every, bool) or not 1 <= every <= 10000:
        raise InputError(f"must be a whole number from 1 to 10000, got {short(every)}", f"{field}.every")
    return Section(block, _params(block.Params, rest, field), every)


def _measuring(library: Library, kind: object) -> str:
    block = library.block("sense", kind, "sensor.kind")
    if all(port.name != "displacement" for port in block.outputs):
        raise InputError(f"{block.name} puts out no displacement; choose a unit that recovers one", "sensor.kind")
    return block.name


def _supervising(library: Library, table: object) -> Section:
    if not isinstance(table, dict):
        raise InputError(f"must be a table, got {short(table)}", SUPERVISOR)
    section = _chosen(library, "supervise", table, SUPERVISOR)
    if section.every != 1:
        raise InputError("a supervisor runs at each tick", f"{SUPERVISOR}.every", "leave it out")
    return section


def _named(library: Library, family: str, key: str, name: str, table: Document) -> Section:
    if not IDENTIFIER.fullmatch(name):
        raise InputError("must be a short name of small letters, digits and _", f"{key}.{name}")
    return _chosen(library, family, table, f"{key}.{name}")


def _params(params: type[BlockParams], values: Document, field: str) -> BlockParams:
    try:
        found = params.model_validate(values, strict=False)
    except ValidationError as error:
        raise from_validation(error, _nested_fields(params)).under(field) from None
    if twice := twice_given(found):
        raise InputError(
            f"gives the step of the converter, and {twice} does too", f"{field}.bits", "leave one of them out"
        )
    return found


def _nested_fields(model: type[BaseModel]) -> dict[str, list[str]]:
    return {"": list(model.model_fields)}

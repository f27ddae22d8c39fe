"""The devices of the catalogue, one TOML file each."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import Any

from pydantic import ValidationError

from core.block import BlockParams
from core.device.device import Device, PrintedFigures
from core.device.drawn_gyroscope import DrawnGyroscope
from core.device.electrodes import Comb, Electrodes, TuningElectrode
from core.device.geometry import Geometry
from core.device.gyroscope import GyroscopeTable
from core.device.transfer_function import TransferFunction
from core.errors import from_validation, unknown
from core.nesting import read_toml


@cache
def devices() -> tuple[Device, ...]:
    """Return every device of the catalogue, by id."""
    folder = files("core.device") / "data"
    texts = [entry.read_text("utf-8") for entry in folder.iterdir() if entry.name.endswith(".toml")]
    parsed = [Device.model_validate(read_toml(text, "device")) for text in texts]
    return tuple(sorted(parsed, key=lambda device: device.id))


@cache
def _documents() -> dict[str, dict[str, Any]]:
    """Return the document of every device of the catalogue, by id."""
    return {entry.id: entry.model_dump(exclude_none=True) for entry in devices()}


def device(overrides: dict[str, Any]) -> Device:
    """Return the device named by ``id`` with the other values written over it.

    Raises
    ------
    InputError
        For an unknown id or a value that is not allowed; the field is below ``device``.
    """
    name = overrides.get("id", "ch3")
    base = _documents()
    if not isinstance(name, str) or name not in base:
        raise unknown("device", name, base, "device.id")
    merged = merge(base[name], overrides)
    try:
        return Device.model_validate(merged)
    except ValidationError as error:
        tables: dict[str, type[BlockParams]] = {
            "": Device,
            "geometry": Geometry,
            "transfer_function": TransferFunction,
            "gyroscope": GyroscopeTable,
            "drawn_gyroscope": DrawnGyroscope,
            "electrodes": Electrodes,
            "electrodes.drive": Comb,
            "electrodes.sense": Comb,
            "electrodes.tuning": TuningElectrode,
            "printed": PrintedFigures,
        }
        fields = {name: list(table.model_fields) for name, table in tables.items()}
        raise from_validation(error, fields).under("device") from None


def merge(base: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    """Return ``base`` with the values of ``over`` written over it, tables merged."""
    result = dict(base)
    for key, value in over.items():
        inner = result.get(key)
        result[key] = merge(inner, value) if isinstance(inner, dict) and isinstance(value, dict) else value
    return result

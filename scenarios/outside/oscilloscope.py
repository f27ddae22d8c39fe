"""An oscilloscope and a generator by SCPI, with the commands of a file: shots in binary, a reference as a table."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Literal

import numpy as np
import pyvisa
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from core.errors import InputError, from_validation, one_line
from scenarios.records.columns import Numbers

READY_TRIES = 1000
"""Queries for a shot that is not ready; each waits for the answer of the instrument."""


class Strict(BaseModel):
    """A table of the file."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class ReadyQuery(Strict):
    """The query by which a shot is found ready, and its answer then."""

    query: str
    answer: str


class ScopeCommands(Strict):
    """The commands of an oscilloscope, and the meaning of its numbers."""

    rate_khz: float = Field(gt=0, le=1e6)
    setup: list[str] = []
    shot: list[str]
    ready: ReadyQuery | None = None
    drive: str
    displacement: str
    type: Literal["b", "B", "h", "H", "i", "I", "f", "d"] = "f"
    big_endian: bool = True
    volts_per_unit: float = 1.0
    um_per_unit: float = 1.0
    pairing: Literal["next", "last"] = "next"


class GeneratorCommands(Strict):
    """The commands of a generator, with {values} or binary values, {frequency_hz}, {amplitude_v} and {count}."""

    setup: list[str] = []
    table: str
    type: Literal["text", "b", "h", "f", "d"] = "text"
    big_endian: bool = True
    start: list[str] = []


class InstrumentCommands(Strict):
    """The file: a table for the oscilloscope, and one for the generator if there is one."""

    scope: ScopeCommands
    generator: GeneratorCommands | None = None


def commands_of(document: dict[str, Any]) -> InstrumentCommands:
    """Return the commands in a document.

    Raises
    ------
    InputError
        Naming the first field that is wrong.
    """
    try:
        return InstrumentCommands.model_validate(document)
    except ValidationError as error:
        raise from_validation(error) from None


@contextmanager
def opened(address: str, library: str, field: str) -> Iterator[Any]:
    """Open an instrument, and let errors on the way to it be one line.

    Raises
    ------
    InputError
        When it cannot be reached, does not answer, or answers with something else.
    """
    manager = None
    try:
        manager = pyvisa.ResourceManager(library)
        yield manager.open_resource(address, read_termination="\n", write_termination="\n")
    except InputError:
        raise
    except (pyvisa.Error, OSError, ValueError, TypeError, AttributeError) as error:  # what libraries of VISA raise
        raise InputError(f"{address}: {one_line(' '.join(str(error).split()))[:200]}", field) from None
    finally:
        if manager is not None:
            manager.close()


class Oscilloscope:
    """Takes shots.

    Parameters
    ----------
    device
        The open instrument.
    commands : ScopeCommands
        Its commands.
    """

    def __init__(self, device: Any, commands: ScopeCommands) -> None:
        self._device, self._commands = device, commands
        for command in commands.setup:
            device.write(command)

    def shot(self) -> tuple[Numbers, Numbers]:
        """Return drive and displacement of a shot, in V and um.

        Raises
        ------
        InputError
            When the shot does not come, or the two have different lengths.
        """
        device, commands = self._device, self._commands
        for command in commands.shot:
            device.write(command)
        if (ready := commands.ready) is not None:
            tries = (device.query(ready.query).strip() == ready.answer for _ in range(READY_TRIES))
            if not any(tries):
                raise InputError(f"{ready.query} has not answered {ready.answer}", "scope.ready")
        drive, displacement = (self._read(query) for query in (commands.drive, commands.displacement))
        if len(drive) != len(displacement) or not len(drive):
            text = f"has {len(displacement)} samples, the drive has {len(drive)}"
            raise InputError(text, "scope.displacement")
        return drive * commands.volts_per_unit, displacement * commands.um_per_unit

    def _read(self, query: str) -> Numbers:
        found = self._device.query_binary_values(
            query, datatype=self._commands.type, is_big_endian=self._commands.big_endian, container=np.array
        )
        return np.asarray(found, np.float64)


def load_table(device: Any, commands: GeneratorCommands, volts: Numbers, rate_khz: float) -> None:
    """Send a table of voltages to a generator, which repeats it from then on: values of its peak, and the peak.

    Raises
    ------
    InputError
        For a table without any voltage, or a command with an unknown place.
    """
    peak = float(np.abs(volts).max())
    if peak == 0.0:
        raise InputError("is 0 V throughout", "--excitation")
    shape = volts / peak
    places = {
        "values": ",".join(f"{value:.6g}" for value in shape),
        "frequency_hz": f"{1e3 * rate_khz / len(volts):.9g}",
        "amplitude_v": f"{peak:.9g}",
        "count": str(len(volts)),
    }
    for command in commands.setup:
        device.write(_filled(command, places))
    if commands.type == "text":
        device.write(_filled(commands.table, places))
    else:
        scale = {"b": 127, "h": 32767}.get(commands.type)
        values = shape if scale is None else np.rint(scale * shape).astype(np.int64)
        filled = _filled(commands.table, places)
        device.write_binary_values(filled, values.tolist(), commands.type, is_big_endian=commands.big_endian)
    for command in commands.start:
        device.write(_filled(command, places))


def _filled(command: str, places: dict[str, str]) -> str:
    try:
        return command.format(**places)
    except (KeyError, IndexError, ValueError):
        raise InputError(f"{command!r} has an unknown place; allowed: {', '.join(places)}", "generator") from None

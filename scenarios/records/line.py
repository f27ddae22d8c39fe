"""The line protocol of instruments: a header as one line of JSON, then blocks of drive and displacement in binary."""

from __future__ import annotations

import json
import struct
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from core.errors import InputError, from_validation, short
from scenarios.records.columns import UNITS, Numbers, plain_unit

MOST_HEADER = 4096
"""Bytes of the longest header."""
MOST_BLOCK = 65_536
"""Samples of the longest block."""
HEAD = struct.Struct("<QqI")
"""Before the samples of a block: its number, the time of its first sample in ns, the count of its samples."""
PAIR = 16
"""Bytes of a sample: drive and displacement, float64, little-endian."""
PARTS = ("drive", "displacement")

Word = Annotated[str, Field(min_length=1, max_length=80)]


class LineHeader(BaseModel):
    """The description of an instrument, before its first block."""

    model_config = ConfigDict(extra="forbid", strict=True)

    version: Literal[1]
    source: str = Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]{0,39}$")
    names: Annotated[list[Word], Field(min_length=2, max_length=2)] = Field(default=list(PARTS))
    units: Annotated[list[Word], Field(min_length=2, max_length=2)] = Field(default=["V", "um"])
    rate_khz: float = Field(gt=0, le=1e6)
    pairing: Literal["next", "last"] = "next"
    session: str = Field(default="", max_length=80)
    shots: bool = False

    @property
    def factors(self) -> Numbers:
        """Factors to V and um."""
        return np.array([UNITS[part][plain_unit(unit)] for part, unit in zip(PARTS, self.units, strict=True)])


class BlockHead(NamedTuple):
    """Number of a block, time of its first sample by the clock of the source in ns, count of its samples."""

    number: int
    time_ns: int
    samples: int


def read_header(line: bytes) -> LineHeader:
    """Return the header in a line.

    Raises
    ------
    InputError
        Naming the first field that is wrong.
    """
    try:
        document: Any = json.loads(line)
    except (ValueError, RecursionError):
        raise InputError("is no JSON", "header", "begin with one line of JSON") from None
    if not isinstance(document, dict):
        raise InputError(f"must be an object of JSON, got {short(document)}", "header")
    try:
        header = LineHeader.model_validate(document)
    except ValidationError as error:
        raise from_validation(error, {"": list(LineHeader.model_fields)}).under("header") from None
    for i, part in enumerate(PARTS):
        if plain_unit(header.units[i]) not in UNITS[part]:
            allowed = ", ".join(UNITS[part])
            text = f"the {part} has the unit {short(header.units[i])}; allowed: {allowed}"
            raise InputError(text, f"header.units.{i}")
    return header


def read_head(content: bytes) -> BlockHead:
    """Return the beginning of a block.

    Raises
    ------
    InputError
        For a block that is empty or too long.
    """
    head = BlockHead(*HEAD.unpack(content))
    if not 1 <= head.samples <= MOST_BLOCK:
        raise InputError(f"has {head.samples} samples; allowed: 1 to {MOST_BLOCK}", f"block {head.number}")
    return head


def read_pairs(head: BlockHead, content: bytes, factors: Numbers) -> NDArray[np.float64]:
    """Return the samples of a block, shape (samples, 2), in V and um; a displacement that is no number is lost.

    Raises
    ------
    InputError
        For a voltage that is no finite number: a bench cannot tell a lost voltage from a voltage of 0.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        pairs = np.frombuffer(content, "<f8").reshape(head.samples, 2) * factors
    wrong = np.flatnonzero(~np.isfinite(pairs[:, 0]))
    if len(wrong):
        raise InputError(f"the drive is no finite number at sample {wrong[0]}", f"block {head.number}")
    pairs[~np.isfinite(pairs[:, 1]), 1] = np.nan
    return pairs


def header_line(header: LineHeader) -> bytes:
    """Return a header as it is sent."""
    return header.model_dump_json().encode() + b"\n"


def block(head: BlockHead, drive: Numbers, displacement: Numbers) -> bytes:
    """Return a block as it is sent."""
    return HEAD.pack(*head) + np.column_stack((drive, displacement)).astype("<f8").tobytes()

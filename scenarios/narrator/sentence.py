"""A sentence of the narrator: data first, and the words made from it."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, Field

Kind = Literal["trip", "switch", "heal", "fault", "verdict", "false_verdict", "settled"]
KINDS: tuple[Kind, ...] = ("trip", "switch", "heal", "fault", "verdict", "false_verdict", "settled")
"""The kinds in the order of the sentences of one tick."""


class Sentence(BaseModel):
    """An event in one sentence, with the numbers in it."""

    tick: int = Field(description="When the sentence was possible")
    kind: Kind
    text: str
    signals: list[str] = Field(description="Where it shows")
    span: tuple[int, int] = Field(description="First and last tick of its subject")
    numbers: dict[str, float] = Field(description="The figures it is made of: um, ms, ticks, shares")

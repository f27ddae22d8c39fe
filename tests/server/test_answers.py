"""Answers that have fields of other records."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
from pydantic import BaseModel, ValidationError

from server.api.bodies import AnswerBody


@dataclass(frozen=True)
class Tone:
    hertz: float
    kept: bool = True


@dataclass(frozen=True)
class Head:
    title: str
    note: str
    tones: tuple[Tone, ...] = ()


class ToneCard(BaseModel):
    """A tone without the rest of its record."""

    hertz: float


class Card(AnswerBody):
    """A card of a head."""

    id: str
    title: str
    note: str
    tones: list[ToneCard]
    left: int = 3


def test_each_field_is_from_the_first_record_that_has_it() -> None:
    first, second = Head("first", "a", (Tone(2.0),)), Head("second", "b")
    assert Card.of(first, second, id="x").title == "first"
    assert Card.of(second, first, id="x").title == "second"


def test_a_given_value_replaces_the_field_of_a_record_which_is_not_read() -> None:
    class Late(Head):
        @property
        def left(self) -> int:
            raise RuntimeError("it is not asked")

    assert Card.of(Late("first", "a"), id="x", note="given", left=4).model_dump() == {
        "id": "x",
        "title": "first",
        "note": "given",
        "tones": [],
        "left": 4,
    }


def test_records_in_a_field_are_read_the_same_way() -> None:
    assert Card.of(Head("first", "a", (Tone(2.0),)), id="x").tones == [ToneCard(hertz=2.0)]


def test_a_field_that_no_record_has_needs_a_default() -> None:
    assert Card.of(Head("first", "a"), id="x").left == 3
    with pytest.raises(ValidationError, match="id"):
        Card.of(Head("first", "a"))

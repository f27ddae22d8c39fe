"""Noise seeds as people write them."""

from __future__ import annotations

import re
from typing import Any, Self

from pydantic import Field, model_validator

from core.board.spec import MOST_SEED
from core.errors import InputError, short
from core.table import Table

MAX_RUNS = 1_000_000
BOTH_ENDS = r"\s*([0-9]{1,16})\s*:\s*([0-9]{1,16})\s*"


def parse_seeds(text: str, field: str = "--seeds") -> range:
    """Read ``A:B``, both included: how seeds are counted everywhere.

    Raises
    ------
    InputError
        If it is not two whole numbers in order.
    """
    whole = re.fullmatch(BOTH_ENDS, text)
    first, last = (int(part) for part in whole.groups()) if whole else (1, 0)
    if not first <= last <= MOST_SEED:
        raise InputError(f"must be A:B with whole numbers A <= B <= {MOST_SEED}, got {short(text)}", field)
    return range(first, last + 1)


class Seeds(Table):
    """Noise seeds, ``"A:B"`` with both ends, the same for every point, so that points differ by their values.

    A first seed and a count are read as well.
    """

    first: int = Field(1, ge=0, le=MOST_SEED, description="first seed")
    count: int = Field(1, ge=1, le=MAX_RUNS, description="number of seeds")

    @model_validator(mode="before")
    @classmethod
    def _both_ends(cls, given: Any) -> Any:
        if not isinstance(given, str):
            return given
        try:
            seeds = parse_seeds(given, "seeds")
        except InputError as error:
            raise ValueError(error.message) from None
        return {"first": seeds[0], "count": len(seeds)}

    @model_validator(mode="after")
    def _reach(self) -> Self:
        last = self.first + self.count - 1
        if last > MOST_SEED:
            raise ValueError(f"the last seed would be {last}; allowed: up to {MOST_SEED}")
        return self

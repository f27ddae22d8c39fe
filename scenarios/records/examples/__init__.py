"""Example records of devices that a simulator of their own makes: ``scripts/make_records.py``."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from core.nesting import read_toml
from core.table import Table

FOLDER = Path(__file__).parent


class ExampleRecord(Table):
    """A record that comes with the project.

    Attributes
    ----------
    title : str
        The device and its peculiarity.
    healthy : int
        Samples from the start that are healthy.
    outcome, sentence : str
        The outcome of a diagnosis on the bench ``first-look``, and words of its sentence.
    right : float
        Least share of the labelled samples after the healthy stretch with the right verdict; 0 where there is none.
    """

    title: str
    healthy: int
    outcome: str
    sentence: str
    right: float = 0.0
    name: str = ""

    @property
    def path(self) -> Path:
        """The file."""
        return FOLDER / f"{self.name}.csv"


@cache
def examples() -> dict[str, ExampleRecord]:
    """Return the example records by name."""
    tables = read_toml((FOLDER / "examples.toml").read_text("utf-8"), "examples.toml")
    return {name: ExampleRecord.model_validate({**table, "name": name}) for name, table in tables.items()}


def example(name: str) -> ExampleRecord | None:
    """Return the example record of a name, or nothing."""
    return examples().get(name)

"""Scenarios of the library, from files and from documents; and how to run them."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Self

from combbench.result import Result
from core.nesting import read_toml
from scenarios import edit, library, schema
from scenarios.reading import read_text
from scenarios.run import run as run_headless


class Scenario(schema.Scenario):
    """A checked scenario; `scenarios.schema.Scenario` lists its attributes."""

    @classmethod
    def load(cls, source: str | Path | dict[str, Any], like: schema.Scenario | None = None) -> Self:
        """Read a scenario, and check everything that a run would refuse.

        Parameters
        ----------
        source : str, Path or dict
            An id of the library, a path to a TOML file, the text of such a file, or a document.
        like : Scenario, optional
            A scenario that may be alike; parts that both have are taken from there.

        Raises
        ------
        InputError
            Naming the field, or the line of malformed TOML.
        """
        if isinstance(source, dict):
            return cls(source, like)
        if isinstance(source, Path) or source.endswith(".toml"):
            return cls(read_toml(read_text(Path(source), "scenario"), "scenario", f"TOML in {source}"), like)
        if "=" in source or "\n" in source:
            return cls(read_toml(source, "scenario"), like)
        return cls(library.get(source).document, like)


def run(
    scenario: schema.Scenario | str | Path | dict[str, Any],
    *,
    seed: int | None = None,
    set: dict[str, Any] | None = None,
    taps: bool = False,
) -> Result:
    """Run a scenario from start to end, with the bits of a live bench.

    Parameters
    ----------
    scenario : Scenario, str, Path or dict
        As for `Scenario.load`.
    seed : int, optional
        Instead of the scenario's own.
    set : dict, optional
        Values to write over the scenario, by dotted paths: ``{"sensor.noise_um": 0.002}``.
    taps : bool
        Keep the inner signals of the blocks as well.

    Raises
    ------
    InputError
        As `Scenario.load`; for a path that leads nowhere.
    """
    read = scenario if isinstance(scenario, schema.Scenario) else Scenario.load(scenario)
    return Result(run_headless(edit.with_values(read, set or {}), seed, taps=taps))

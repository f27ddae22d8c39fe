"""Scenarios of the library, from files and from documents; and how to run them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Self

from combbench.result import Result
from core.board.hosted import NOTHING
from core.board.outside import Conclusion, Law
from scenarios import edit, schema
from scenarios.run import run as run_headless
from scenarios.source import Source, document_of


class Scenario(schema.Scenario):
    """A checked scenario; `scenarios.schema.Scenario` lists its attributes."""

    @classmethod
    def load(
        cls,
        source: Source,
        like: schema.Scenario | None = None,
        *,
        set: dict[str, Any] | None = None,
    ) -> Self:
        """Read a scenario, and check everything that a run would refuse.

        Parameters
        ----------
        source : str, Path, bytes, file or dict
            An id of the library, a path to a TOML file, the text of such a file, or a document; `document_of` has the
            rule for texts.
        like : Scenario, optional
            A scenario that may be alike; parts that both have are taken from there.
        set : dict, optional
            Values to write over the scenario, by dotted paths: ``{"sensor.noise_um": 0.002}``.

        Raises
        ------
        InputError
            Naming the field, or the line of malformed TOML; for a path that leads nowhere.
        """
        read = cls(document_of(source), like)
        return cls(edit.written(read.document, set), read) if set else read


def run(
    scenario: schema.Scenario | Source,
    *,
    seed: int | None = None,
    set: dict[str, Any] | None = None,
    taps: bool = False,
    law: Law | None = None,
    diagnosers: Mapping[str, Conclusion] = NOTHING,
    identifiers: Mapping[str, Conclusion] = NOTHING,
) -> Result:
    """Run a scenario from start to end, with the bits of a live bench.

    Parameters
    ----------
    scenario : Scenario, str, Path, bytes, file or dict
        As for `Scenario.load`.
    seed : int, optional
        Instead of the scenario's own.
    set : dict, optional
        Values to write over the scenario, as for `Scenario.load`.
    taps : bool
        Keep the inner signals of the blocks as well.
    law : callable, optional
        Drives in place of the controller of the scenario: called with each `core.board.outside.Sample`, it answers with
        a voltage.
    diagnosers, identifiers : mapping
        Callables by id, beside the blocks of the scenario: called with each `core.board.outside.Observation`, they
        answer with the probability of each hypothesis, or with mass, stiffness and damping over nominal.

    Raises
    ------
    InputError
        As `Scenario.load`; for a path that leads nowhere.
    """
    read = scenario if isinstance(scenario, schema.Scenario) else Scenario.load(scenario)
    chosen = edit.with_values(read, set or {})
    return Result(run_headless(chosen, seed, taps=taps, law=law, diagnosers=diagnosers, identifiers=identifiers))

"""The result of a run, for NumPy, xarray, pandas and files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from core.block import FloatArray
from core.board.commands import Trip
from core.errors import InputError, unknown
from core.signals import CLOCK, Signal
from scenarios.arrow import pa
from scenarios.report.traces import schema_of
from scenarios.run import RunResult
from scenarios.schema import Scenario
from server.version import VERSION

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

NETCDF = "nc"
USUAL = ("plant.displacement", "model.displacement", "drive.voltage")
"""Signals that a plot shows unless others are named."""


class Result:
    """The traces and figures of a run.

    Parameters
    ----------
    headless : RunResult
        The run.
    """

    def __init__(self, headless: RunResult) -> None:
        self._headless = headless

    @property
    def scenario(self) -> Scenario:
        """The scenario that was run, with the values that were set."""
        return self._headless.scenario

    @property
    def seed(self) -> int:
        """Seed of the noise."""
        return self._headless.seed

    @property
    def digest(self) -> str:
        """Hash of every sample of every output: equal runs have equal digests."""
        return self._headless.digest

    @property
    def figures(self) -> dict[str, float]:
        """Figures of the run by name, such as ``rms_error``; `expectations` has units and judgements."""
        return self._headless.metrics

    @property
    def warnings(self) -> list[str]:
        """Warnings of the run, each once."""
        return self._headless.warnings

    @property
    def trip(self) -> Trip | None:
        """Why the board stopped early, if it did."""
        return self._headless.trip

    @property
    def time(self) -> FloatArray:
        """Device time of each sample, shape ``(samples,)``, ms."""
        return np.arange(self._headless.samples, dtype=np.float64) * self._headless.board.dt_ms

    @property
    def signals(self) -> list[Signal]:
        """The signals whose traces were kept: name, unit, meaning, block."""
        return self._headless.kept

    def signal(self, name: str) -> FloatArray:
        """Return the trace of a signal, shape ``(samples,)``, in the unit that `signals` gives.

        Raises
        ------
        InputError
            When there is no such signal, or it was not kept.
        """
        return self._headless.signal(name)

    def expectations(self) -> list[dict[str, Any]]:
        """Return each expectation of the scenario with the measured figure and whether it holds."""
        return self._headless.expectations()

    def to_xarray(self) -> xr.Dataset:
        """Return the traces over the coordinate ``time``, with units and names by the CF conventions; needs xarray."""
        import xarray as xr

        axis = {"units": "ms", "standard_name": "time", "long_name": "device time"}
        traces = {
            one.name: ("time", self.signal(one.name), {"units": one.unit or "1", "long_name": one.meaning})
            for one in self.signals
        }
        head = self.scenario.head
        about = {
            "Conventions": "CF-1.11",
            "title": head.title,
            "source": f"CombBench {VERSION}, simulated",
            "references": head.source,
            "scenario": json.dumps(self.scenario.document, default=str),
            "seed": self.seed,
            "digest": self.digest,
        }
        return xr.Dataset(traces, {"time": ("time", self.time, axis)}, about)

    def to_pandas(self) -> pd.DataFrame:
        """Return the traces as columns, by ``time_ms``; ``attrs["units"]`` has the unit of each; needs pandas."""
        import pandas as pd

        frame = pd.DataFrame(
            {one.name: self.signal(one.name) for one in self.signals}, pd.Index(self.time, name=CLOCK[1])
        )
        frame.attrs["units"] = {one.name: one.unit for one in self.signals}
        return frame

    def plot(self, *names: str) -> Figure:
        """Draw signals over time, one axes for each unit; needs matplotlib.

        Parameters
        ----------
        *names : str
            Signals; displacement, reference model and drive voltage if none is named.

        Raises
        ------
        InputError
            For an unknown signal, and for a study, which has no traces.
        """
        from matplotlib.figure import Figure

        units = {one.name: one.unit for one in self.signals}
        if not len(self.time):
            raise InputError("has no traces to draw: it is a study, see its figures", self.scenario.id)
        chosen = names or [name for name in USUAL if name in units] or [*units][:1]
        for name in chosen:
            if name not in units:
                raise unknown("signal", name, list(units), "names")
        rows = list(dict.fromkeys(units[name] for name in chosen))
        figure = Figure(figsize=(9, 1.2 + 2.4 * len(rows)), layout="constrained")
        places = figure.subplots(len(rows), sharex=True, squeeze=False)[:, 0]
        for unit, place in zip(rows, places, strict=True):
            for name in chosen:
                if units[name] == unit:
                    place.plot(self.time, self.signal(name), label=name, linewidth=1)
            place.set_ylabel(unit or "1")
            place.legend(loc="upper right")
        places[0].set_title(self.scenario.head.title)
        places[-1].set_xlabel("time, ms")
        return figure

    def save(self, path: str | Path) -> Path:
        """Write the traces to a file; its ending says the format: parquet, csv, npz, mat, mcap, or nc for netCDF.

        Raises
        ------
        InputError
            For another ending, and where the file cannot be written.
        """
        from server.store.traces import MEDIA_TYPES, write

        target = Path(path)
        kind = target.suffix.removeprefix(".")
        if kind not in (*MEDIA_TYPES, NETCDF):
            raise unknown("format", kind, [*MEDIA_TYPES, NETCDF], "path")
        part = target.with_name(target.name + ".part")
        try:
            if kind == NETCDF:
                self.to_xarray().to_netcdf(part, engine="scipy")
            else:
                with part.open("wb") as file:
                    write(self._table(), file, kind)  # type: ignore[arg-type]
            part.replace(target)
        except OSError as error:
            raise InputError(f"cannot write {target}: {error.strerror}", "path") from None
        finally:
            part.unlink(missing_ok=True)
        return target

    def _table(self) -> Any:
        """Return the traces as an Arrow table, in double precision."""
        about = {"scenario": self.scenario.document, "seed": self.seed, "digest": self.digest, "version": VERSION}
        schema = schema_of({one.name: one.unit for one in self.signals}, about)
        columns = [np.arange(len(self.time)), self.time, *(self.signal(one.name) for one in self.signals)]
        return pa.table(columns, schema=schema)

"""Tables: headless runs and campaigns, their results, recordings, links. Bulk data is in files; a row has the name."""

from __future__ import annotations

from datetime import datetime
from typing import Any

from sqlalchemy import BigInteger, Float, Integer, String, false
from sqlalchemy.orm import Mapped, mapped_column

from server.store.base import Base, now


class RequestRow(Base):
    """A requested computation, a run with its seeds or a campaign; the table of results has the outcomes.

    Attributes
    ----------
    kind : str
        ``run`` or ``campaign``.
    key : str
        Its key; the id is its beginning.
    name : str
        Id of the scenario of a run, or of the campaign.
    document : dict
        The scenario of a run, or the campaign.
    seeds : list of int
        Seeds of a run.
    everything : bool
        Whether the trace of a run has the signals of blocks in shadow as well.
    version : str
        Of the code; runs from before it was kept have none.
    runs, done : int
        Its number of different runs, and the number in the table of results when it ended.
    attempts : int
        Starts in a row without a result.
    summary : dict
        Digest of a run.
    """

    __tablename__ = "requests"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    kind: Mapped[str] = mapped_column(String(16), index=True)
    key: Mapped[str] = mapped_column(String(64), default="", server_default="")
    state: Mapped[str] = mapped_column(String(16), index=True)
    name: Mapped[str] = mapped_column(String(200))
    scenario_id: Mapped[str] = mapped_column(String(200))
    title: Mapped[str] = mapped_column(String(400))
    label: Mapped[str] = mapped_column(String(120), default="", server_default="")
    document: Mapped[dict[str, Any]]
    seeds: Mapped[list[Any] | None]
    everything: Mapped[bool] = mapped_column(default=False, server_default=false())
    version: Mapped[str] = mapped_column(String(16), default="", server_default="")
    runs: Mapped[int] = mapped_column(Integer)
    done: Mapped[int] = mapped_column(Integer, default=0, server_default="0")
    attempts: Mapped[int] = mapped_column(Integer, default=0, server_default="0")
    created: Mapped[datetime] = mapped_column(default=now, index=True)
    finished: Mapped[datetime | None]
    summary: Mapped[dict[str, Any] | None]
    error: Mapped[dict[str, Any] | None]

    @property
    def progress(self) -> float:
        """Share of the runs that were done when it ended."""
        return self.done / self.runs if self.runs else 0.0


class ResultRow(Base):
    """One single run, by its key: scenario, seed and version. All runs and campaigns share these rows."""

    __tablename__ = "results"

    key: Mapped[str] = mapped_column(String(64), primary_key=True)
    outcome: Mapped[dict[str, Any]]
    created: Mapped[datetime] = mapped_column(default=now, index=True)


class RecordingRow(Base):
    """One recording of a live bench."""

    __tablename__ = "recordings"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    bench_id: Mapped[str] = mapped_column(String(32), index=True)
    name: Mapped[str] = mapped_column(String(200))
    state: Mapped[str] = mapped_column(String(16), index=True)
    title: Mapped[str] = mapped_column(String(400))
    dt_ms: Mapped[float] = mapped_column(Float)
    start_tick: Mapped[int] = mapped_column(BigInteger)
    ticks: Mapped[int] = mapped_column(BigInteger, default=0)
    signals: Mapped[list[Any]]
    scenario: Mapped[dict[str, Any] | None]
    events: Mapped[list[Any] | None]
    layout: Mapped[dict[str, Any] | None]
    seed: Mapped[int | None] = mapped_column(BigInteger)
    version: Mapped[str] = mapped_column(String(64), default="", server_default="")
    condition: Mapped[str] = mapped_column(String(200), default="", server_default="")
    bytes: Mapped[int] = mapped_column(BigInteger, default=0, server_default="0")
    created: Mapped[datetime] = mapped_column(default=now, index=True)
    finished: Mapped[datetime | None]
    reason: Mapped[str] = mapped_column(String(400), default="")


class RecordRow(Base):
    """A record of a device; rows with the same numbers share a file, which has their key as its name.

    Attributes
    ----------
    owner : str
        Id of the student who brought it; empty: the teacher.
    about : dict
        What its file said: columns, notes, labels, ranges.
    """

    __tablename__ = "records"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    key: Mapped[str] = mapped_column(String(64), index=True)
    name: Mapped[str] = mapped_column(String(200))
    owner: Mapped[str] = mapped_column(String(32), index=True)
    rate_khz: Mapped[float] = mapped_column(Float)
    samples: Mapped[int] = mapped_column(BigInteger)
    bytes: Mapped[int] = mapped_column(BigInteger)
    about: Mapped[dict[str, Any]]
    created: Mapped[datetime] = mapped_column(default=now, index=True)


class MeasuredDeviceRow(Base):
    """A device that a record calibrated."""

    __tablename__ = "measured_devices"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    name: Mapped[str] = mapped_column(String(100), unique=True)
    record_key: Mapped[str] = mapped_column(String(64))
    values: Mapped[dict[str, Any]]
    calibration: Mapped[dict[str, Any]]
    created: Mapped[datetime] = mapped_column(default=now)


class ParameterSetRow(Base):
    """A named set of parameters."""

    __tablename__ = "parameter_sets"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    name: Mapped[str] = mapped_column(String(100), unique=True)
    scenario: Mapped[str] = mapped_column(String(200))
    values: Mapped[dict[str, Any]]
    created: Mapped[datetime] = mapped_column(default=now)


class LinkRow(Base):
    """An experiment or a layout by a short id, or a closed idle bench by its own."""

    __tablename__ = "links"

    id: Mapped[str] = mapped_column(String(32), primary_key=True)
    kind: Mapped[str] = mapped_column(String(16), index=True)
    title: Mapped[str] = mapped_column(String(200))
    note: Mapped[str] = mapped_column(String(2000))
    scenario_id: Mapped[str | None] = mapped_column(String(200))
    tick: Mapped[int | None] = mapped_column(BigInteger)
    digest: Mapped[str | None] = mapped_column(String(64))
    version: Mapped[str] = mapped_column(String(64))
    content: Mapped[dict[str, Any]]
    bytes: Mapped[int] = mapped_column(BigInteger)
    created: Mapped[datetime] = mapped_column(default=now, index=True)

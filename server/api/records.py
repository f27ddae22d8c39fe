"""Records of real devices: files brought in, looked at, calibrated and diagnosed."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, TypeVar

from fastapi import Depends, Query, Request, Response
from pydantic import BaseModel, Field

from scenarios.records.reading import Pairing
from server.api.bodies import Body, Source
from server.api.deps import PersonDep, RateLimited, ServiceDep
from server.api.paging import AgePage
from server.api.router import API, Router
from server.bench.record_work import (
    RecordMapping,
    calibrated,
    columns_of,
    diagnosed,
    take_in,
    thinned,
)
from server.computing.computing import LONGEST_S
from server.errors import ApiError
from server.security.body import too_large
from server.security.person import Person
from server.service import Service
from server.store.measured_records import KeptRecord

router = Router(prefix="/records", tags=["records"])

UPLOADS = (f"{API}/records", f"{API}/records/columns")
"""Paths whose bodies are files."""
FILE = {
    "requestBody": {
        "required": True,
        "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}},
    }
}
MOST_POINTS = 4000
T = TypeVar("T")


class FileColumn(BaseModel):
    """A column of a file."""

    name: str
    unit: str
    is_number: bool


class FileColumns(BaseModel):
    """The columns of a file, and the column of each part that has a usual name."""

    columns: list[FileColumn]
    found: dict[str, str] = Field(description="Column of time, drive, displacement and label, where it was found")


class RecordList(BaseModel):
    """Records, newest first."""

    records: list[KeptRecord]


class RecordPlot(BaseModel):
    """Extremes of the columns over stretches of samples; null: all samples of a stretch are lost."""

    sample: list[int] = Field(description="First sample of each stretch")
    drive_low: list[float | None]
    drive_high: list[float | None]
    displacement_low: list[float | None]
    displacement_high: list[float | None]


class RecordDetail(KeptRecord):
    """A record, with its columns thinned for a plot."""

    plot: RecordPlot


class HealthyStretch(Body):
    """The samples of a record that are healthy, and the bench whose nominal device they are compared with."""

    scenario: Source = "first-look"
    first: int = Field(0, ge=0, le=2**53, description="First sample")
    end: int | None = Field(
        None, ge=1, le=2**53, description="The sample after the last; null: a quarter of the record"
    )


class Estimated(BaseModel):
    """A number with its standard error and its 95 % interval."""

    value: float
    error: float
    low: float
    high: float


class FitCheck(BaseModel):
    """A reason against the fit, which was looked for: its figure, its limit, and the sentence where it was found."""

    name: str
    value: float
    limit: float
    ok: bool
    sentence: str


class RecordCalibration(BaseModel):
    """The device behind a healthy stretch; a refusal says why it does not fit."""

    mass: Estimated = Field(description="Over nominal, at the nominal force")
    damping: Estimated
    stiffness: Estimated
    offset_um: Estimated
    delay_samples: Estimated
    noise_um: float
    quantum_um: float = Field(description="Step of the converter; 0: none is seen")
    samples: int
    checks: list[FitCheck]
    refusal: str = Field(description="Why the record does not fit; empty: it does")
    values: dict[str, float] = Field(description="Values by dotted path that give a bench this device")


class VerdictStretch(BaseModel):
    """Samples with one verdict: a hypothesis, `unsure` or `unexplained`."""

    first: int
    end: int
    verdict: str
    probability: float


class BankVerdicts(BaseModel):
    """The verdicts of a bank over a record."""

    name: str
    healthy: str = Field(description="Its hypothesis of no fault")
    shares: dict[str, float] = Field(description="Share of the samples of each verdict, the largest first")
    verdicts: list[VerdictStretch]
    left_out: int = Field(description="Stretches beyond those listed")


class DiagnosedRecord(BaseModel):
    """The calibration of a record, and the verdicts of all banks; none after a refusal."""

    calibration: RecordCalibration
    refusal: str
    banks: list[BankVerdicts]
    figures: dict[str, float | None] = Field(description="Figures with the score, of a record with labels")


def get_mapping(
    name: Annotated[
        str, Query(min_length=1, max_length=200, description="Name of the file; its ending says the format")
    ],
    time: Annotated[str | None, Query(max_length=200, description="Column of the times")] = None,
    drive: Annotated[str | None, Query(max_length=200, description="Column of the voltage")] = None,
    displacement: Annotated[str | None, Query(max_length=200, description="Column of the displacement")] = None,
    label: Annotated[str | None, Query(max_length=200, description="Column of the known verdicts")] = None,
    rate_khz: Annotated[float | None, Query(gt=0, le=1e6, description="Samples for each ms, without times")] = None,
    pairing: Annotated[
        Pairing, Query(description="The voltage of a row acts from its sample on (next), or acted until it (last)")
    ] = "next",
) -> RecordMapping:
    """Read from the query how the columns of a file are to be read."""
    named = {"time": time, "drive": drive, "displacement": displacement, "label": label}
    return RecordMapping(name, {part: one for part, one in named.items() if one}, rate_khz, pairing)


def owner_of(person: Person) -> str | None:
    """Return the id of a student, whose records are the only ones to see; nothing for the teacher."""
    return None if person.is_teacher else person.id


async def get_record(record_id: str, service: ServiceDep, person: PersonDep) -> KeptRecord:
    """Return the record in the path, or refuse the record of another as if it were not there."""
    return await service.measured_records.get(record_id, owner_of(person))


RecordDep = Annotated[KeptRecord, Depends(get_record)]


@router.post(
    "",
    status_code=201,
    dependencies=[RateLimited],
    openapi_extra=FILE,
    responses={200: {"model": KeptRecord, "description": "The same record was here already"}},
)
async def bring_record(
    request: Request,
    mapping: Annotated[RecordMapping, Depends(get_mapping)],
    service: ServiceDep,
    person: PersonDep,
    response: Response,
) -> KeptRecord:
    """Keep the record in a file, which is the body: CSV, Parquet, MAT, NetCDF or HDF5."""
    owner = owner_of(person) or ""
    await service.measured_records.check_room(owner)
    most = _most(service, person)
    with service.measured_records.uploading() as folder:
        upload = await _received(request, service, person, folder)
        taken = await _compute(service, take_in, upload, mapping, most)
        file = folder / f"{taken.key}.npz"
        found, is_new = await service.measured_records.keep(
            mapping.name,
            owner,
            file,
            taken.key,
            rate_khz=taken.rate_khz,
            samples=taken.samples,
            bytes=taken.bytes,
            about=taken.about,
        )
    response.status_code = 201 if is_new else 200
    response.headers["Location"] = f"{API}/records/{found.id}"
    return found


@router.post("/columns", dependencies=[RateLimited], openapi_extra=FILE)
async def read_columns(
    request: Request,
    name: Annotated[str, Query(min_length=1, max_length=200, description="Name of the file")],
    service: ServiceDep,
    person: PersonDep,
) -> FileColumns:
    """Return the columns of a file, to choose from; of a text its first lines are enough. Nothing is kept."""
    with service.measured_records.uploading() as folder:
        upload = await _received(request, service, person, folder)
        return FileColumns.model_validate(await _compute(service, columns_of, upload, name))


@router.get("")
async def list_records(service: ServiceDep, person: PersonDep, page: AgePage) -> RecordList:
    """List the records, newest first; a student sees the own records."""
    return RecordList(records=await service.measured_records.all(owner_of(person), page))


@router.get("/{record_id}")
async def get_record_plot(
    record: RecordDep,
    service: ServiceDep,
    start: Annotated[int, Query(ge=0, description="First sample of the plot")] = 0,
    end: Annotated[int | None, Query(ge=1, description="The sample after the last; left out: the end")] = None,
    points: Annotated[int, Query(ge=1, le=MOST_POINTS, description="Most stretches of the plot")] = 1000,
) -> RecordDetail:
    """Describe a record, with minimum and maximum of its columns over a range of samples."""
    last = record.samples if end is None else min(end, record.samples)
    if start >= last:
        raise ApiError(422, "invalid", f"must be before {last}, got {start}", "start")
    samples = await service.measured_records.samples(record)
    plot = await asyncio.to_thread(thinned, samples, start, last, points)
    return RecordDetail(**record.model_dump(), plot=RecordPlot(**plot))


@router.delete("/{record_id}", status_code=204, dependencies=[RateLimited])
async def delete_record(record: RecordDep, service: ServiceDep) -> None:
    """Delete a record that no live bench plays; a student may delete the own records."""
    for bench in service.benches.all():
        if bench.scenario.document.get("plant", {}).get("record") == record.key:
            raise ApiError(409, "conflict", "a live bench plays this record", hint=f"close the bench {bench.id} first")
    await service.measured_records.delete(record)


@router.post("/{record_id}/calibration", dependencies=[RateLimited])
async def calibrate_record(body: HealthyStretch, record: RecordDep, service: ServiceDep) -> RecordCalibration:
    """Fit mass, damping, stiffness, offset, delay and noise to half of a healthy stretch; test by the other half."""
    return RecordCalibration.model_validate(await on_record(service, calibrated, body, record))


@router.post("/{record_id}/diagnosis", dependencies=[RateLimited])
async def diagnose_record(body: HealthyStretch, record: RecordDep, service: ServiceDep) -> DiagnosedRecord:
    """Calibrate by a healthy stretch, and let the banks of a bench diagnose the whole record."""
    return DiagnosedRecord.model_validate(await on_record(service, diagnosed, body, record))


async def on_record(service: Service, work: Callable[..., T], body: HealthyStretch, record: KeptRecord) -> T:
    """Do work on a record, one at a time, in a process that computes."""
    units = service.units.beside({})
    return await _compute(service, work, body.scenario, units, record.key, body.first, body.end)


async def _compute(service: Service, work: Callable[..., T], *arguments: Any) -> T:
    service.computing.check_budget()
    async with service.experiment_turn:
        return await service.computing.call(work, *arguments, most_s=LONGEST_S)


def _most(service: Service, person: Person) -> int:
    """Return the bytes that a record of a person may have."""
    settings = service.settings
    return (settings.max_record_mb if person.is_teacher else settings.student_record_mb) << 20


async def _received(request: Request, service: Service, person: Person, folder: Path) -> Path:
    """Put the body of a request into a file as it comes, and never into memory."""
    most, room, path, size = _most(service, person), await service.keeping.room(), folder / "upload", 0
    with path.open("wb") as file:
        async for piece in request.stream():
            size += len(piece)
            if size > most:
                raise too_large(most, "max_record_mb" if person.is_teacher else "student_record_mb")
            if size > room:
                raise ApiError(507, "no_space", "the record is larger than the room that is left (quota_bytes)")
            file.write(piece)
    if not size:
        raise ApiError(422, "invalid", "the file is empty", "record")
    return path

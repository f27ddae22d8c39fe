"""Instruments that send their samples, and benches on them; for the teacher alone."""

from __future__ import annotations

import asyncio
from typing import Annotated

from fastapi import Response
from pydantic import BaseModel, Field

from server.api.bodies import Body, Source, Values
from server.api.deps import PersonDep, RateLimited, ServiceDep
from server.api.paging import pages
from server.api.router import Router
from server.bench.build import read_scenario
from server.bench.status import Bench
from server.instruments.source import SourceStatus
from server.paging import ListPage

router = Router(prefix="/instruments", tags=["instruments"])


class InstrumentList(BaseModel):
    """The instruments that have connected since the server was started, by name."""

    listens: str = Field(description="Address and port for instruments; empty: none may connect (instrument_port)")
    instruments: list[SourceStatus]


class BenchOnInstrument(Body):
    """The bench whose identifiers and diagnosers look at an instrument."""

    scenario: Source = "first-look"
    set: Values = Field({}, description="Such as the fitted device: device.mass_kg, plant.offset_um")
    device: str = Field("", max_length=40, description="Id of a measured device; empty: the scenario's own")
    noise_um: float | None = Field(
        None, gt=0, le=100, description="Noise that filters assume; null: the noise of the scenario"
    )
    paused: bool = Field(False, description="Start paused; the samples are kept meanwhile")


@router.get("")
async def list_instruments(service: ServiceDep, page: Annotated[ListPage, pages(str)]) -> InstrumentList:
    """List the instruments that have connected, with the counts of their blocks."""
    found = page.cut((one.status() for one in service.instruments.all()), lambda one: (one.name,))
    return InstrumentList(listens=service.instruments.listens, instruments=found)


@router.post("/{name}/benches", status_code=201, dependencies=[RateLimited])
async def open_on_instrument(
    name: str, body: BenchOnInstrument, service: ServiceDep, person: PersonDep, response: Response
) -> Bench:
    """Make a bench that plays an instrument from its next block on.

    The samples are kept as a record, under the key in the status of the bench. A run of its scenario gives the same
    bits.
    """
    source = service.instruments.get(name)
    values = body.set
    if body.device:
        device = await service.measured_devices.get(body.device)
        values = {**device.for_bench(plays_record=True), **values}
    await service.benches.check(body.scenario, {})
    scenario = await asyncio.to_thread(read_scenario, body.scenario)
    session = await service.instruments.open(source, scenario, body.noise_um, values, body.paused)
    response.headers["Location"] = f"/api/v1/benches/{session.id}"
    return await service.views.opened(session, person)

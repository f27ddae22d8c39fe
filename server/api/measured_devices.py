"""Measured devices: calibrated by a record, kept by name, put on any bench."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, Field

from server.api.deps import PersonDep, RateLimited, ServiceDep
from server.api.paging import pages
from server.api.records import HealthyStretch, on_record, owner_of
from server.api.router import Router
from server.bench.record_work import calibrated
from server.errors import ApiError
from server.paging import ListPage
from server.store.measured_devices import MeasuredDevice

router = Router(prefix="/measured-devices", tags=["records"])


class NewMeasuredDevice(HealthyStretch):
    """A record, its healthy stretch, and the name of the device."""

    name: str = Field(min_length=1, max_length=100, description="Name, which no other measured device may have")
    record: str = Field(max_length=40, description="Id of the record")


class MeasuredDeviceList(BaseModel):
    """Measured devices by name."""

    devices: list[MeasuredDevice]


@router.post("", status_code=201, dependencies=[RateLimited])
async def save_measured_device(body: NewMeasuredDevice, service: ServiceDep, person: PersonDep) -> MeasuredDevice:
    """Calibrate a record, and keep its device for other benches."""
    record = await service.measured_records.get(body.record, owner_of(person))
    await service.measured_devices.check(body.name)
    found = await on_record(service, calibrated, body, record)
    if found["refusal"]:
        raise ApiError(422, "refused", found["refusal"], "record", "choose another stretch, or another excitation")
    return await service.measured_devices.save(body.name, record.key, found["values"], found)


@router.get("")
async def list_measured_devices(service: ServiceDep, page: Annotated[ListPage, pages(str)]) -> MeasuredDeviceList:
    """List the measured devices by name."""
    return MeasuredDeviceList(devices=await service.measured_devices.all(page))


@router.delete("/{device_id}", status_code=204, dependencies=[RateLimited])
async def delete_measured_device(device_id: str, service: ServiceDep) -> None:
    """Forget a measured device; benches that have it keep it."""
    await service.measured_devices.delete(device_id)

"""Experiments on a copy of a live bench; the bench itself does not notice."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import Annotated, Any, TypeVar

import numpy as np
from fastapi import Query
from pydantic import BaseModel, Field

from core.board.board import Board
from core.board.flops import Budget, budget
from core.board.stored import Stored, revived, stored
from core.device.device import Device
from core.device.frequency import response
from core.device.identification import Identified
from core.errors import InputError
from core.own.admission import kept
from core.units import UM_PER_M
from scenarios.measure.plant_cost import PlantCost, plant_costs
from scenarios.measure.sweep_sine import sweep_sine
from scenarios.measure.unstable_region import unstable_region
from server.api.bodies import Body
from server.api.deps import RateLimited, SeenDep, ServiceDep, SessionDep
from server.api.router import Router
from server.bench.bench import LiveBench
from server.bench.replay import REFUSAL
from server.classroom.hiding import blind_of
from server.computing.computing import LONGEST_S
from server.service import Service

router = Router(prefix="/benches/{bench_id}", tags=["experiments"])

MOST_TICKS = 3_000_000
"""Ticks of one pass of a sweep: some seconds of this machine."""
CURVE_POINTS = 300
T = TypeVar("T")


class SweptSine(Body):
    """The settings of a swept sine."""

    amplitude_v: float = Field(2.0, ge=1e-6, le=1000)
    points: int = Field(31, ge=4, le=200, description="Tones of each of the two passes")
    cycles: float = Field(40.0, ge=2, le=1000, description="Cycles measured at each tone")
    settle: float = Field(12.0, ge=0, le=100, description="Time constants waited before")
    start_hz: float | None = Field(None, gt=0)
    stop_hz: float | None = Field(None, gt=0)


class MeasuredTone(BaseModel):
    """One tone: displacement per volt, its standard error and its phase, the sign of the force left out."""

    frequency_hz: float
    gain_um_per_v: float
    error_um_per_v: float
    phase_deg: float


class FittedCurve(BaseModel):
    """The response of the device found, and the response of the nominal device."""

    frequency_hz: list[float]
    found_um_per_v: list[float]
    found_deg: list[float]
    nominal_um_per_v: list[float]
    nominal_deg: list[float]


class Identification(BaseModel):
    """The device that a swept sine identifies on a bench as it is now."""

    tick: int
    found: Identified
    nominal: dict[str, float] = Field(
        description="Figures of the device as it is meant to be, in the air of the catalogue, without faults"
    )
    tones: list[MeasuredTone]
    curve: FittedCurve


class FoldPoint(BaseModel):
    """The last rest position under a slowly rising drive: travel, voltage, place of the worst corner sideways."""

    x_um: float
    volts: float
    lateral_um: float


class SafeBoundary(BaseModel):
    """The speed beyond which the energy suffices to reach the stators, along x."""

    x_um: list[float]
    speed_um_ms: list[float]


class UnstableRegionMap(BaseModel):
    """The region where a bench as it is now pulls in; empty if its plant cannot."""

    tick: int
    plant: str
    drive_v: float
    folds: list[FoldPoint]
    boundary: SafeBoundary | None


class MeasuredPlant(BaseModel):
    """CPU time of one tick of the whole bench with this plant; null when it cannot have it."""

    name: str
    title: str
    ns_per_tick: float | None
    refused: str


class MeasuredPlants(BaseModel):
    """The cost of every plant, and device time of one tick to compare it with."""

    plants: list[MeasuredPlant]
    tick_ns: float


@router.post("/identification", dependencies=[RateLimited])
async def identification(body: SweptSine, session: SessionDep, seen: SeenDep, service: ServiceDep) -> Identification:
    """Identify the device by a swept sine, with the faults and the air it has now; a hidden fault is measured too."""
    blind = blind_of(session) if seen is session.view else None
    believed = blind.nominal() if blind is not None else None
    return await _on_copy(session, service, _identify, body, believed)


@router.get("/unstable-region", dependencies=[RateLimited])
async def region(
    session: SessionDep, service: ServiceDep, drive_v: Annotated[float, Query(ge=-1000, le=1000)] = 0.0
) -> UnstableRegionMap:
    """Map where the shuttle pulls in, for a voltage held on it."""
    return await _on_copy(session, service, _map, drive_v)


@router.get("/plants", dependencies=[RateLimited])
async def plants(session: SessionDep, service: ServiceDep) -> MeasuredPlants:
    """Measure the cost of a tick with each plant."""
    costs = await _on_copy(session, service, _plant_costs)
    return MeasuredPlants(plants=[MeasuredPlant(**asdict(cost)) for cost in costs], tick_ns=1e6 * session.dt_ms)


@router.get("/flops", dependencies=[RateLimited])
async def flops(
    session: SessionDep,
    service: ServiceDep,
    board_mflops: Annotated[float, Query(gt=0, le=1e9, description="Millions of operations per second")] = 50.0,
    function_flops: Annotated[float, Query(ge=0, le=1e4, description="Operations for one exponential")] = 20.0,
) -> Budget:
    """Count the operations of every diagnoser as it is now, and compare them with a board of some speed."""
    return await _on_copy(session, service, budget, board_mflops * 1e6, function_flops)


async def _on_copy(session: LiveBench, service: Service, work: Callable[..., T], *settings: Any) -> T:
    """Run one experiment at a time on a copy of a bench, in parallel with the event loop and the engine."""
    async with service.experiment_turn:
        with kept():
            copy = await service.engine.call(_copied, session)
            return await service.computing.call(_with_board, copy, work, *settings, most_s=LONGEST_S)


def _copied(session: LiveBench) -> Stored:
    """Return the board of a bench as plain data (a job of the engine)."""
    if not isinstance(session.board, Board):
        raise InputError(REFUSAL, "bench", "run its scenario to branch off", "conflict")
    return stored(session.board)


def _with_board(copy: Stored, work: Callable[..., T], *settings: Any) -> T:
    return work(revived(copy), *settings)


def _plant_costs(board: Board) -> list[PlantCost]:
    return plant_costs(board.checkpoint())


def _identify(board: Board, body: SweptSine, believed: Device | None) -> Identification:
    sweep = sweep_sine(board, **body.model_dump(), most_ticks=MOST_TICKS, believed=believed)
    device = believed or board.spec.device
    force = device.signed_force_n_per_v
    sign = 1.0 if force > 0.0 else -1.0
    identified, nominal = sweep.found, device.metrics()
    grid = np.geomspace(sweep.tones[0].frequency_hz, sweep.tones[-1].frequency_hz, CURVE_POINTS)
    unit = abs(force) * UM_PER_M
    response_found = response(identified.mass_kg, identified.damping_ns_m, identified.stiffness_n_m, grid) * unit
    response_meant = response(nominal["mass_kg"], nominal["damping_ns_m"], nominal["stiffness_n_m"], grid) * unit
    return Identification(
        tick=board.tick,
        found=identified,
        nominal=nominal,
        tones=[
            MeasuredTone(
                frequency_hz=tone.frequency_hz,
                gain_um_per_v=abs(tone.response),
                error_um_per_v=tone.error,
                phase_deg=float(np.degrees(np.angle(sign * tone.response))),
            )
            for tone in sweep.tones
        ],
        curve=FittedCurve(
            frequency_hz=grid.tolist(),
            found_um_per_v=np.abs(response_found).tolist(),
            found_deg=np.degrees(np.angle(response_found)).tolist(),
            nominal_um_per_v=np.abs(response_meant).tolist(),
            nominal_deg=np.degrees(np.angle(response_meant)).tolist(),
        ),
    )


def _map(board: Board, drive_v: float) -> UnstableRegionMap:
    region = unstable_region(board, drive_v)
    edge = region.boundary
    return UnstableRegionMap(
        tick=board.tick,
        plant=region.plant,
        drive_v=drive_v,
        folds=[FoldPoint(**asdict(fold)) for fold in region.folds],
        boundary=edge and SafeBoundary(x_um=edge.x_um.tolist(), speed_um_ms=edge.speed_um_ms.tolist()),
    )

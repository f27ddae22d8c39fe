"""Experiments on a copy of a live bench; the bench itself does not notice."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Annotated, TypeVar

from fastapi import Query
from pydantic import BaseModel, Field

from core.board.board import Board
from core.board.flops import Budget, budget
from core.board.stored import Stored, revived, stored
from core.errors import InputError
from core.own.admission import kept
from scenarios.measure.identification import Identification
from scenarios.measure.identification import identification as identified
from scenarios.measure.plant_cost import MeasuredPlant, plant_costs
from scenarios.measure.unstable_region import UnstableRegionMap, unstable_region
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
T = TypeVar("T")


class SweptSine(Body):
    """The settings of a swept sine."""

    amplitude_v: float = Field(2.0, ge=1e-6, le=1000, description="Amplitude of each tone, V")
    points: int = Field(31, ge=4, le=200, description="Tones of each of the two passes")
    cycles: float = Field(40.0, ge=2, le=1000, description="Cycles measured at each tone")
    settle: float = Field(12.0, ge=0, le=100, description="Time constants waited before each tone is measured")
    start_hz: float | None = Field(None, gt=0, description="Lowest frequency; null: a quarter of the natural frequency")
    stop_hz: float | None = Field(None, gt=0, description="Highest frequency; null: twice the natural frequency")


class MeasuredPlants(BaseModel):
    """The cost of every plant, and device time of one tick to compare it with."""

    plants: list[MeasuredPlant]
    tick_ns: float


@router.post("/identification", dependencies=[RateLimited])
async def identification(body: SweptSine, session: SessionDep, seen: SeenDep, service: ServiceDep) -> Identification:
    """Identify the device by a swept sine, with the faults and the air it has now; a hidden fault is measured too."""
    blind = blind_of(session) if seen is session.view else None
    believed = blind.nominal() if blind is not None else None
    work = partial(identified, believed=believed, most_ticks=MOST_TICKS, **body.model_dump())
    return await _on_copy(session, service, work)


@router.get("/unstable-region", dependencies=[RateLimited])
async def region(
    session: SessionDep, service: ServiceDep, drive_v: Annotated[float, Query(ge=-1000, le=1000)] = 0.0
) -> UnstableRegionMap:
    """Map where the shuttle pulls in while a voltage is held on it."""
    return await _on_copy(session, service, partial(unstable_region, drive_v=drive_v))


@router.get("/plants", dependencies=[RateLimited])
async def plants(session: SessionDep, service: ServiceDep) -> MeasuredPlants:
    """Measure the cost of a tick with each plant."""
    return MeasuredPlants(plants=await _on_copy(session, service, plant_costs), tick_ns=1e6 * session.dt_ms)


@router.get("/flops", dependencies=[RateLimited])
async def flops(
    session: SessionDep,
    service: ServiceDep,
    board_mflops: Annotated[float, Query(gt=0, le=1e9, description="Millions of operations per second")] = 50.0,
    function_flops: Annotated[float, Query(ge=0, le=1e4, description="Operations for one exponential")] = 20.0,
) -> Budget:
    """Count the operations of every diagnoser as it is now, and compare them with a board of some speed."""
    work = partial(budget, board_flops=1e6 * board_mflops, function_flops=function_flops)
    return await _on_copy(session, service, work)


async def _on_copy(session: LiveBench, service: Service, work: Callable[[Board], T]) -> T:
    """Run one experiment at a time on a copy of a bench, in parallel with the event loop and the engine."""
    async with service.experiment_turn:
        with kept():
            copy = await service.engine.call(_copied, session)
            return await service.computing.call(_with_board, copy, work, most_s=LONGEST_S)


def _copied(session: LiveBench) -> Stored:
    """Return the board of a bench as plain data (a job of the engine)."""
    if not isinstance(session.board, Board):
        raise InputError(REFUSAL, "bench", "run its scenario to branch off", "conflict")
    return stored(session.board)


def _with_board(copy: Stored, work: Callable[[Board], T]) -> T:
    return work(revived(copy))

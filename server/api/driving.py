"""Driving a bench that several have open: ask for it, hand it over, take it back."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import BaseModel, Field, model_validator

from server.api.bodies import Body
from server.api.deps import PersonDep, RateLimited, ServiceDep, SessionDep
from server.api.router import Router
from server.bench.status import Company

router = Router(prefix="/benches/{bench_id}/driving", tags=["classes"])


class DrivingTurn(Body):
    """The requested change of the driver."""

    do: Literal["ask", "hand_over", "refuse", "take", "leave"] = Field(
        description=(
            "ask: request the bench from its driver. hand_over: let a person drive. refuse: decline a request. take: "
            "drive at once (the teacher, or a student who handed over the own bench). leave: the next person who gives "
            "a command drives"
        )
    )
    to: str = Field("", max_length=32, description="Id of the person who is to drive, or whose request is declined")

    @model_validator(mode="after")
    def _has_a_person(self) -> Self:
        if (self.do in ("hand_over", "refuse")) != bool(self.to):
            raise ValueError("hand_over and refuse need to; nothing else has it")
        return self


class Drives(BaseModel):
    """The users of the bench now."""

    company: Company | None = Field(description="Persons who have the bench open; null while there is only one")


@router.post("", dependencies=[RateLimited])
async def change_driver(body: DrivingTurn, session: SessionDep, person: PersonDep, service: ServiceDep) -> Drives:
    """Change the driver of a bench, or request the bench."""
    driving = service.driving
    if body.do == "hand_over":
        driving.hand_over(session.id, person, body.to)
    elif body.do == "refuse":
        driving.refuse(session.id, person, body.to)
    else:
        {"ask": driving.ask, "take": driving.take, "leave": driving.leave}[body.do](session.id, person)
    return Drives(company=driving.company(session.id))

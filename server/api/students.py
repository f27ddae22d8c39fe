"""Students of a class in the path of a request, and the outcome of an action for many of them."""

from __future__ import annotations

from collections.abc import Awaitable, Sequence

from pydantic import BaseModel, Field

from server.errors import REFUSED, ApiError, not_found, why
from server.security.person import Person
from server.service import Service


class Outcomes(BaseModel):
    """The outcome of a command to many benches."""

    done: int = Field(description="Number of students for whom it was done")
    failed: list[str] = Field(description="Name of each student for whom it was refused, and the reason")

    @classmethod
    def of(cls, refusals: Sequence[str | None]) -> Outcomes:
        """Count the refusals of the students, None where it was done."""
        failed = [text for text in refusals if text is not None]
        return cls(done=len(refusals) - len(failed), failed=failed)


async def refusal(person: Person, action: Awaitable[object]) -> str | None:
    """Carry out an action for a student; return the name and the reason if it is refused."""
    try:
        await action
    except REFUSED as error:
        return f"{person.name}: {why(error)}"
    return None


async def student_of(service: Service, class_id: str, member_id: str) -> Person:
    """Return a student of a class; refuse an unknown id."""
    for person in await students_of(service, class_id):
        if person.id == member_id:
            return person
    raise not_found("student", member_id)


async def students_of(service: Service, class_id: str, members: Sequence[str] | None = None) -> list[Person]:
    """Return the students of a class, or some of them; refuse unknown ids."""
    await service.classes.row(class_id)
    students = service.people.students(class_id)
    known = {person.id for person in students}
    for position, member in enumerate(members or ()):
        if member not in known:
            raise ApiError(422, "invalid", f"there is no student '{member}'", f"members.{position}")
    return [person for person in students if members is None or person.id in members]

"""The students of a class, as the doors of a class name them."""

from __future__ import annotations

from server.errors import ApiError, not_found
from server.security.person import Person
from server.service import Service


async def student_of(service: Service, class_id: str, member_id: str) -> Person:
    """Return a student of a class; refuse an unknown id."""
    await service.classes.row(class_id)
    for person in service.people.students(class_id):
        if person.id == member_id:
            return person
    raise not_found("student", member_id)


async def students_of(service: Service, class_id: str, members: list[str] | None) -> list[Person]:
    """Return the students of a class, or some of them; refuse unknown ids."""
    await service.classes.row(class_id)
    students = service.people.students(class_id)
    if members is None:
        return students
    known = {person.id for person in students}
    for position, member in enumerate(members):
        if member not in known:
            raise ApiError(422, "invalid", f"there is no student '{member}'", f"members.{position}")
    return [person for person in students if person.id in members]

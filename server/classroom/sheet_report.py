"""The sheet to hand in, as one HTML file: text, answers, points and reasons."""

from __future__ import annotations

import asyncio

from core.format import format_short
from server.classroom.sheets import Sheets
from server.errors import ApiError
from server.security.person import Person
from server.store.recordings import Recording, Recordings


async def sheet_report(sheets: Sheets, stored: Recordings, person: Person, sheet_id: str) -> str:
    """Return the report of a person's work at a sheet.

    Raises
    ------
    ApiError
        For an unknown sheet, or a sheet that the person has not begun.
    """
    from scenarios.report.sheet import sheet_html  # loads Markdown, mathematics and templates

    sheet = sheets.get(sheet_id)
    work = next((work for work in sheets.works(person.id) if work.sheet_id == sheet.id), None)
    if work is None:
        raise ApiError(409, "conflict", "the sheet has not been begun", "sheet", "begin it first")
    view = await sheets.view(person, sheet.id)
    traces = {name: step.trace for name, step in work.progress.steps.items() if step.trace}
    name = person.name if person.role == "student" else ""
    kept = {one.id: one for one in await stored.all()} if view.recordings else {}
    recordings = [_recording(kept.get(recording_id), recording_id) for recording_id in view.recordings]
    return await asyncio.to_thread(sheet_html, view.model_dump(), traces, recordings, name, work.begun)


def _recording(recording: Recording | None, recording_id: str) -> str:
    """Say which recording was handed in."""
    if recording is None:
        return f"{recording_id}, which has been deleted"
    length, start = (format_short(ticks * recording.dt_ms, "ms") for ticks in (recording.ticks, recording.start_tick))
    return f"{recording.name}: {length} from {start} ({recording.id})"

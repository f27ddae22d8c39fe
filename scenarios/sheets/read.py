"""Reads a sheet: front matter between lines of ``+++``, then sections that begin with ``## ``."""

from __future__ import annotations

import re
from typing import Any

from pydantic import TypeAdapter, ValidationError

from core.errors import InputError, from_validation
from core.nesting import read_toml
from core.text import without_mark
from scenarios.reading import without_address
from scenarios.sheets.sheet import AnyStep, BlindStep, Hold, Prediction, Sheet, SheetHead, SheetQuestion, SheetSection

FENCE, MARK, END = "+++", "```step", "```"
LONGEST = 200_000
"""Characters of a sheet."""
_STEP: TypeAdapter[Hold | SheetQuestion | Prediction | BlindStep] = TypeAdapter(AnyStep)
_AT_LINE = re.compile(r"\(at line (\d+), column \d+\)")


def read_sheet(text: str, name: str) -> Sheet:
    """Read a sheet; its formulas are not tried yet (`check`).

    Parameters
    ----------
    text : str
        Markdown with front matter.
    name : str
        The id of the sheet.

    Raises
    ------
    InputError
        One line: sheet, line, step and field.
    """
    if len(text) > LONGEST:
        raise InputError(f"has more than {LONGEST} characters", f"sheet {name}")
    lines = without_mark(text).replace("\r\n", "\n").split("\n")
    if lines[0].strip() != FENCE or FENCE not in (line.strip() for line in lines[1:]):
        raise at(name, 1, "", InputError(f"begins with front matter between two lines of {FENCE}"))
    end = next(i for i, line in enumerate(lines) if i and line.strip() == FENCE)
    head = _table(name, "", lines, 1, end, SheetHead.model_validate)
    starts = [i for i in range(end + 1, len(lines)) if lines[i].startswith("## ") and not _is_fenced(lines, end, i)]
    if not starts:
        raise at(name, end + 1, "", InputError("has no section; one begins with '## '"))
    intro = "\n".join(lines[end + 1 : starts[0]]).strip()
    ends = [*starts[1:], len(lines)]
    sections = tuple(_section(name, lines, start, stop) for start, stop in zip(starts, ends, strict=True))
    sheet = Sheet(name, head, intro, sections, text)
    _refuse_doubles(sheet)
    return sheet


def at(name: str, line: int, step: str, error: InputError) -> InputError:
    """Return an error with the sheet, the line and the step it is about."""
    where = f"sheet {name}, line {line}" + (f", step {step}" if step else "")
    return InputError(error.message, f"{where}, {error.field}" if error.field else where, error.hint, error.code)


def _section(name: str, lines: list[str], start: int, stop: int) -> SheetSection:
    heading = lines[start].removeprefix("## ").strip()
    marks = [i for i in range(start, stop) if lines[i].strip() == MARK]
    if len(marks) > 1:
        raise at(name, marks[1] + 1, "", InputError("a section has one step; begin another section before this one"))
    if not marks:
        return SheetSection(heading, "\n".join(lines[start + 1 : stop]).strip(), None, "", start + 1)
    begin = marks[0]
    end = next((i for i in range(begin + 1, stop) if lines[i].strip() == END), None)
    if end is None:
        raise at(name, begin + 1, "", InputError(f"the step has no end; it ends with a line of {END}"))
    step = _table(name, _id_of(lines, begin + 1, end), lines, begin + 1, end, _STEP.validate_python)
    text, after = ("\n".join(lines[a:b]).strip() for a, b in ((start + 1, begin), (end + 1, stop)))
    return SheetSection(heading, text, step, after, start + 1, begin + 1)


def _table(name: str, step: str, lines: list[str], start: int, stop: int, validate: Any) -> Any:
    """Read lines of TOML into a model."""
    try:
        document = read_toml("\n".join(lines[start:stop]), "")
    except InputError as error:
        found = _AT_LINE.search(error.message)
        line = start + (int(found[1]) if found else 1)
        raise at(name, line, step, InputError(_AT_LINE.sub("", error.message).strip())) from None
    try:
        return validate(without_address(document))
    except ValidationError as error:
        refused = from_validation(error)
        path = ".".join(part for part in refused.field.split(".") if part not in ("hold", "question", "prediction"))
        line = line_of(lines, start, stop, path)
        raise at(name, line, step, InputError(refused.message, path, refused.hint)) from None


def line_of(lines: list[str], start: int, stop: int, path: str) -> int:
    """Return the line of a field, as near as possible; counted from 1."""
    words = [part for part in path.split(".") if not part.isdigit()]
    for word in reversed(words):
        form = re.compile(rf'(^|[\s{{,.\[])"?{re.escape(word)}"?\s*(=|\])')
        found = [i for i in range(start, stop) if form.search(lines[i])]
        if found:
            place = next((int(part) for part in path.split(".") if part.isdigit()), 0)
            return (found[place] if place < len(found) else found[0]) + 1
    return start + 1


def _id_of(lines: list[str], start: int, stop: int) -> str:
    found = (re.match(r'\s*id\s*=\s*"([^"]*)"', line) for line in lines[start:stop])
    return next((match[1] for match in found if match), "")


def _is_fenced(lines: list[str], start: int, line: int) -> bool:
    """Whether a line is inside a block of code."""
    return sum(text.lstrip().startswith("```") for text in lines[start:line]) % 2 == 1


def _refuse_doubles(sheet: Sheet) -> None:
    """Refuse two steps of one id, and a prediction that is judged behind no later step."""
    seen: dict[str, int] = {}
    place = {step.id: position for position, step in enumerate(sheet.steps)}
    for section in sheet.sections:
        step = section.step
        if step is None:
            continue
        if step.id in seen:
            raise at(sheet.id, section.step_line, step.id, InputError(f"is the id of line {seen[step.id]} too", "id"))
        seen[step.id] = section.step_line
        if isinstance(step, Prediction) and place.get(step.until, -1) <= place[step.id]:
            later = ", ".join(name for name, position in place.items() if position > place[step.id]) or "none"
            refused = InputError(f"is no later step: {step.until}; allowed: {later}", "until")
            raise at(sheet.id, section.step_line, step.id, refused)
    if not seen:
        raise at(sheet.id, sheet.sections[0].line, "", InputError("no section has a step"))

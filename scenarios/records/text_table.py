"""Columns from text: CSV with any separator and decimal sign, with or without a line of units."""

from __future__ import annotations

import csv
import io
import re
from dataclasses import dataclass
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from core.errors import InputError, one_line, short
from scenarios.arrow import csv as arrow_csv
from scenarios.arrow import pa
from scenarios.records.columns import Columns, refuse_large

SEPARATORS = (";", "\t", ",", "|", " ")
"""Tried in this order: a decimal comma is more likely than a separator within a field."""
COMMENTS = ("#", "%", "//")
LONGEST_LINE = 65_536
LOOKED_AT = 50
"""Lines from which separator and decimal sign are found."""
LOST = ("", "nan", "NaN", "NAN", "NA", "N/A", "null", "None", "-nan", "nan(ind)", "-nan(ind)")
"""Words for a sample that was not measured."""
_NUMBER = re.compile(r"[+-]?([0-9]+[.,]?[0-9]*|[.,][0-9]+)([eEdD][+-]?[0-9]+)?")
"""A number as it may be written; `_NUMERAL` as it is read."""
_NUMERAL = re.compile(r"[+-]?(([0-9]+\.?[0-9]*|\.[0-9]+)([eEdD][+-]?[0-9]+)?|inf|infinity)", re.IGNORECASE)
_ROW = re.compile(r"Row #(\d+)")
_COLUMN = re.compile(r"column #(\d+)")
_VALUE = re.compile(r"invalid value '(.*?)'")


@dataclass(frozen=True)
class Form:
    """How a text is written: separator, decimal sign, names and units, and the count of lines before the numbers."""

    separator: str
    decimal: str
    names: list[str]
    units: dict[str, str]
    before: int


def text_columns(content: bytes) -> Columns:
    """Return the columns of a text.

    Raises
    ------
    InputError
        For bytes that are no text, a text without names or rows, and a row with another number of fields.
    """
    text = _decoded(content)
    lines = list(islice(_lines(text), LOOKED_AT))
    form = _form(lines)
    if form.separator == " ":
        text = re.sub(r"(?m)^ +| +$", "", re.sub(r"[ \t]+", " ", text))
    refuse_large(len(form.names), text.count("\n") - form.before)
    columns = Columns(form.names, {}, {}, form.units, form.before + 1, _rows(text, form), form.decimal)
    table = _read(text, form)
    for i, name in enumerate(form.names):
        column = table.column(i)
        try:
            numbers = _numbers(column, form.decimal)
            columns.numbers[name] = np.ascontiguousarray(numbers.to_numpy(zero_copy_only=False), dtype=np.float64)
        except pa.ArrowInvalid:  # words: a label, or a mistake that is named once the column is needed
            columns.words[name] = column.to_pylist()
    return columns


def mistake(columns: Columns, name: str) -> InputError:
    """Return the refusal of a column that is needed as numbers: its first word that is no number."""
    words = columns.words[name]
    for i, word in enumerate(words):
        plain = word.strip().replace(columns.decimal, ".")
        if plain not in LOST and _NUMERAL.fullmatch(plain) is None:
            text = f"row {columns.row(i)}, column {one_line(short(name))}: {one_line(short(word))} is no number"
            return InputError(text, "record")
    return InputError(f"column {one_line(short(name))} has words and no numbers", "record")


def _rows(text: str, form: Form) -> NDArray[np.int64] | None:
    """Return the line of each row, where lines without a row are between them."""
    if "\n\n" not in text:
        return None
    lines = text.split("\n")
    return np.array([i + 1 for i, line in enumerate(lines) if i >= form.before and line], dtype=np.int64)


def _decoded(content: bytes) -> str:
    """Return the text of a file: UTF-8, UTF-16 with its mark, or the Latin alphabet of an instrument."""
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        encoding = "utf-16"
    elif b"\0" in content[:LONGEST_LINE]:
        raise InputError("is no text: it contains bytes of zero", "record")
    else:
        encoding = "utf-8-sig"
    try:
        text = content.decode(encoding)
    except UnicodeDecodeError:
        if encoding == "utf-16":
            raise InputError("is marked as UTF-16 and is no UTF-16 text", "record") from None
        text = content.decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _lines(text: str) -> list[str]:
    """Return the first lines of a text; refuse a line that is too long."""
    head = text[: LOOKED_AT * LONGEST_LINE].split("\n", LOOKED_AT)[:LOOKED_AT]
    for i, line in enumerate(head):
        if len(line) > LONGEST_LINE:
            raise InputError(f"row {i + 1} is longer than {LONGEST_LINE} characters", "record")
    return head


def _form(lines: list[str]) -> Form:
    """Find separator, decimal sign, names and units."""
    skipped = next((i for i, line in enumerate(lines) if line.strip() and not _is_comment(line)), None)
    if skipped is None:
        raise InputError("has no rows", "record")
    some = [line for line in lines[skipped:] if line.strip()]
    separator = _separator(some)
    rows = [_fields(line, separator) for line in some]
    if all(_is_number(word) for word in rows[0]):
        numbered = [str(i + 1) for i in range(len(rows[0]))]
        return Form(separator, _decimal(rows, separator), numbered, {}, skipped)
    names = [name.strip().lstrip("#% ") for name in rows[0]]
    before, units = skipped + 1, dict[str, str]()
    if len(rows) > 1 and not any(_is_number(word) or word in LOST for word in rows[1]):
        units = {name: word.strip("()[] ") for name, word in zip(names, rows[1], strict=False)}
        before += 1
    if len(rows) < before - skipped + 1:
        raise InputError("has a line of names and no rows", "record")
    return Form(separator, _decimal(rows[before - skipped :], separator), names, units, before)


def _is_comment(line: str) -> bool:
    return line.lstrip().startswith(COMMENTS)


def _separator(lines: list[str]) -> str:
    """Return the separator that all lines have equally often."""
    for separator in SEPARATORS:
        counts = {len(_fields(line, separator)) for line in lines[:-1] or lines}
        if len(counts) == 1 and counts.pop() > 1:
            return separator
    counted = [(len(_fields(line, separator)), separator) for separator in SEPARATORS for line in lines[:1]]
    most, separator = max(counted, key=lambda one: one[0])
    if most == 1:
        raise InputError("has one column; drive and displacement are needed", "record")
    return separator


def _fields(line: str, separator: str) -> list[str]:
    if separator == " ":
        return line.split()
    return [word.strip() for word in next(csv.reader(io.StringIO(line), delimiter=separator), [])]


def _decimal(rows: list[list[str]], separator: str) -> str:
    words = [word for row in rows for word in row if _is_number(word)]
    if separator == "," or not any("," in word for word in words):
        return "."
    if any("." in word for word in words):
        raise InputError("has numbers with a point and numbers with a comma; one decimal sign is needed", "record")
    return ","


def _is_number(word: str | None) -> bool:
    return word is not None and _NUMBER.fullmatch(word.strip()) is not None


def _read(text: str, form: Form) -> pa.Table:
    """Return all fields as text."""
    try:
        return arrow_csv.read_csv(
            pa.BufferReader(text.encode()),
            read_options=arrow_csv.ReadOptions(
                column_names=form.names, skip_rows=form.before, use_threads=False, block_size=8 << 20
            ),
            parse_options=arrow_csv.ParseOptions(delimiter=form.separator, ignore_empty_lines=True),
            convert_options=arrow_csv.ConvertOptions(
                column_types={name: pa.string() for name in form.names}, strings_can_be_null=False
            ),
        )
    except pa.ArrowInvalid as error:
        told = str(error)
        row, fields = _ROW.search(told), re.search(r"Expected (\d+) columns, got (\d+)", told)
        if row and fields:
            counted = f"row {row[1]} has {fields[2]} fields, the first has {fields[1]}"
            raise InputError(counted, "record") from None
        raise InputError(f"cannot be read as a table: {one_line(short(told, 120))}", "record") from None


def _numbers(column: pa.ChunkedArray, decimal: str) -> pa.ChunkedArray:
    """Return words as numbers; words for a lost sample become no numbers."""
    import pyarrow.compute as pc

    words = pc.utf8_trim_whitespace(column)
    if decimal == ",":
        words = pc.replace_substring(words, ",", ".")
    words = pc.replace_substring_regex(words, "^([-+.0-9]+)[dD]", r"\1e")  # as Fortran writes exponents
    lost = pc.is_in(words, value_set=pa.array(LOST))
    words = pc.if_else(lost, pa.scalar(None, pa.string()), words)
    return pc.fill_null(pc.cast(words, pa.float64()), float("nan"))

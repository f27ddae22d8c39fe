"""The formats of traces: the page and the document of REST name each format that the server writes."""

from __future__ import annotations

import re
from pathlib import Path
from typing import get_args

from server.store.traces import MEDIA_TYPES, Format


def test_every_format_has_a_media_type_and_is_offered_by_the_page_and_the_document(root: Path) -> None:
    formats = get_args(Format)
    assert list(MEDIA_TYPES) == list(formats)
    page = (root / "web" / "src" / "ui" / "downloads.tsx").read_text("utf-8")
    listed = re.search(r"TRACE_FORMATS = \[(.*?)\]", page)
    assert listed and tuple(re.findall(r'"(\w+)"', listed[1])) == formats
    document = (root / "docs" / "rest.md").read_text("utf-8")
    sentence = re.search(r"You get it as (.*?);", document)
    assert sentence and set(re.findall(r"`(\w+)`", sentence[1])) == set(formats)


def test_the_page_has_one_list_of_them(root: Path) -> None:
    source = root / "web" / "src"
    naming = [path.name for path in source.rglob("*.ts*") if '"npz"' in path.read_text("utf-8")]
    assert [name for name in naming if name != "schema.d.ts"] == ["downloads.tsx"]

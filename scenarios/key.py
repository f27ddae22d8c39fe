"""The key of a run: the same scenario, seed and version give the same bits, so such a run is computed only once."""

from __future__ import annotations

import hashlib
import json
from functools import cache
from pathlib import Path
from typing import Any

from core.board.document import written_over
from core.board.packages import carried

SCENARIOS = Path(__file__).resolve().parent
CORE = SCENARIOS.parent / "core"


@cache
def code_version() -> str:
    """Return a hash of the code that results depend on: every Python file of ``core`` and ``scenarios``."""
    digest = hashlib.sha256()
    for folder in (CORE, SCENARIOS):
        for path in sorted(folder.rglob("*.py")):
            digest.update(path.relative_to(folder.parent).as_posix().encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def content_hash(document: dict[str, Any]) -> str:
    """Return a hash of a scenario without its seed, with the packages it names; the order of fields does not matter.

    The printed marks are left out: no run depends on them.
    """
    whole = written_over(carried(document), {})
    content = {name: value for name, value in whole.items() if name not in ("seed", "printed")}
    return hashlib.sha256(json.dumps(content, sort_keys=True, default=str).encode()).hexdigest()


def run_key(content: str, *seeds: int) -> str:
    """Return the key of the runs of a scenario, by the hash of its content, with some seeds and this version."""
    return hashlib.sha256(f"{content} {seeds} {code_version()}".encode()).hexdigest()

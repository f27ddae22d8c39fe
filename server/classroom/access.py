"""The right that each door of the service needs: one table, which the gate reads and the tests check.

A door is a method and a path; doors of WebSockets have the method ``SOCKET``. A door that is not in the table is open
to the teacher alone, so that a new route is closed until it gets an entry. While a fault is hidden on the bench of a
student, only the doors marked ``*`` stay open for that student. A line has all methods of a path.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum

from starlette.routing import compile_path

SOCKET = "SOCKET"
Door = tuple[str, str]
"""A method and a path."""


class Need(Enum):
    """The right that opens a door."""

    NOTHING = "nothing"
    SESSION = "any session"
    MEMBER = "the session of a student"
    WATCH = "may watch the bench in the path"
    MAY_DRIVE = "may drive the bench in the path, also while others drive"
    DRIVE = "may drive the bench in the path, and no other person drives it"
    TEACHER = "the teacher"


API = "/api/v1"
BENCH = f"{API}/benches/{{bench_id}}"
CLASS = f"{API}/classes/{{class_id}}"

_DOORS = {
    Need.NOTHING: f"""
        GET /health/live
        GET /health/ready
        GET POST /join
        GET /watch
        GET /watch/{{secret}}
        POST {CLASS}/join
        GET {API}/schemas
        GET {API}/schemas/{{name}}
    """,
    Need.SESSION: f"""
        GET /docs  *
        GET /docs/{{path:path}}  *
        GET /design  *
        GET /design/{{device_id}}  *
        GET /gallery  *
        GET /gallery/{{scenario_id}}  *
        GET /scores  *
        GET /theory  *
        GET /theory/{{words}}  *
        GET {API}/openapi.json  *
        GET {API}/me  *
        PUT {API}/me/hand  *
        GET {API}/me/layout  *
        PUT {API}/me/vote  *
        GET {API}/catalog  *
        GET {API}/devices  *
        POST {API}/devices/evaluate  *
        POST {API}/devices/bode  *
        POST {API}/devices/spread  *
        GET {API}/scenarios  *
        GET {API}/scenarios/{{scenario_id}}  *
        GET POST {API}/benches  *
        GET {API}/recordings
        GET {API}/recordings/{{recording_id}}
        GET {API}/recordings/{{recording_id}}/progress
        GET {API}/recordings/{{recording_id}}/trace
        GET {API}/gallery  *
        GET {API}/gallery/{{scenario_id}}/figure  *
        GET {API}/benchmarks  *
        GET {API}/benchmarks/{{benchmark_id}}  *
        GET {API}/sheets  *
        GET {API}/sheets/{{sheet_id}}  *
        GET {API}/sheets/{{sheet_id}}/report  *
        POST {API}/sheets/{{sheet_id}}/begin
        POST {API}/sheets/{{sheet_id}}/steps/{{step_id}}/answer  *
        POST {API}/sheets/{{sheet_id}}/steps/{{step_id}}/hide
        POST {API}/sheets/{{sheet_id}}/steps/{{step_id}}/hint  *
        POST {API}/sheets/{{sheet_id}}/steps/{{step_id}}/close  *
        PUT {API}/sheets/{{sheet_id}}/recordings/{{recording_id}}
        GET {API}/games  *
        GET {API}/games/{{game_id}}  *
        POST {API}/games/{{game_id}}/begin  *
        POST {API}/games/{{game_id}}/attempts  *
        POST {API}/games/{{game_id}}/reveal  *
        POST {API}/theory/positive-real  *
        POST {API}/theory/positive-definite  *
        POST {API}/theory/persistency  *
        POST {API}/theory/aliases  *
        POST {API}/theory/instability-map  *
        POST {API}/qr  *
    """,
    Need.MEMBER: f"""
        POST GET {API}/records
        POST {API}/records/columns
        GET DELETE {API}/records/{{record_id}}
        POST {API}/records/{{record_id}}/calibration
        POST {API}/records/{{record_id}}/diagnosis
        GET {API}/measured-devices
        POST {API}/scenarios/check
        GET POST {API}/units
        GET {API}/units/{{name}}
        GET {API}/parameter-sets
        GET {API}/parameter-sets/{{set_id}}
        GET {API}/parameter-sets/{{set_id}}/difference
    """,
    Need.WATCH: f"""
        GET {BENCH}  *
        GET {BENCH}/events  *
        GET {BENCH}/narration  *
        GET {BENCH}/scenario
        GET {BENCH}/digest
        GET {BENCH}/trace  *
        GET {BENCH}/captures  *
        GET {BENCH}/unstable-region
        GET {BENCH}/plants
        GET {BENCH}/flops
        GET {BENCH}/diagnosers/{{name}}/explain
        GET {BENCH}/diagnosers/{{name}}/turn
        GET {BENCH}/diagnosers/{{name}}/aliases
        GET {BENCH}/readouts/{{name}}
        GET {BENCH}/claims
        GET {BENCH}/printed
        GET {BENCH}/snapshots
        GET {BENCH}/recordings
        SOCKET {BENCH}/stream  *
        GET /benches/{{bench_id}}/3d/
        SOCKET /benches/{{bench_id}}/3d
    """,
    Need.MAY_DRIVE: f"""
        POST {BENCH}/reopen  *
        POST {BENCH}/driving  *
        POST {BENCH}/identification  *
        POST {BENCH}/diagnosers/{{name}}/aliases
    """,
    Need.DRIVE: f"""
        POST {BENCH}/commands  *
        POST {BENCH}/snapshots
        DELETE {BENCH}/snapshots/{{snapshot_id}}
        POST {BENCH}/snapshots/{{snapshot_id}}/restore
        POST {BENCH}/parameter-sets/{{set_id}}
        POST {BENCH}/recordings
        POST {BENCH}/recordings/{{recording_id}}/stop
        GET POST DELETE {BENCH}/blind  *
        POST {BENCH}/blind/answer  *
    """,
    Need.TEACHER: f"""
        DELETE {BENCH}  *
        PATCH {BENCH}
        POST {BENCH}/fork
        POST {BENCH}/variant
        POST {BENCH}/parameter-sets
        GET {BENCH}/file.html
        GET {API}/scenarios/{{scenario_id}}/file.html
        GET {BENCH}/audit
        POST GET {BENCH}/watchers
        DELETE {BENCH}/watchers/{{watcher_id}}
        PATCH DELETE {API}/parameter-sets/{{set_id}}
        DELETE {API}/recordings/{{recording_id}}
        POST {API}/recordings/{{recording_id}}/replay
        POST {API}/recordings/{{recording_id}}/compare
        POST {API}/measured-devices
        DELETE {API}/measured-devices/{{device_id}}
        PUT DELETE {API}/units/{{name}}
        POST GET {API}/runs
        POST {API}/runs/remove
        GET {API}/runs/compare
        GET {API}/runs/compare/trace
        GET PATCH DELETE {API}/runs/{{run_id}}
        GET {API}/runs/{{run_id}}/progress
        GET {API}/runs/{{run_id}}/scenario
        GET {API}/runs/{{run_id}}/trace
        GET {API}/runs/{{run_id}}/report
        GET {API}/runs/{{run_id}}/thumbnail
        GET {API}/runs/{{run_id}}/script
        POST GET {API}/sweeps
        POST {API}/sweeps/remove
        GET PATCH DELETE {API}/sweeps/{{sweep_id}}
        GET {API}/sweeps/{{sweep_id}}/progress
        GET {API}/sweeps/{{sweep_id}}/points
        GET {API}/sweeps/{{sweep_id}}/distribution
        GET {API}/sweeps/{{sweep_id}}/picture
        GET {API}/sweeps/{{sweep_id}}/runs
        GET {API}/sweeps/{{sweep_id}}/report
        GET {API}/sweeps/{{sweep_id}}/script
        POST {API}/thresholds
        GET DELETE {API}/thresholds/{{threshold_id}}
        GET {API}/thresholds/{{threshold_id}}/progress
        POST {API}/gallery/run
        POST {API}/sheets
        DELETE {API}/sheets/{{sheet_id}}
        DELETE {API}/sheets/{{sheet_id}}/progress
        POST {CLASS}/sheet
        GET {CLASS}/grades
        GET {CLASS}/sheets/{{sheet_id}}/{{member_id}}/report
        POST GET {API}/links
        GET PATCH DELETE {API}/links/{{link_id}}
        POST {API}/links/{{link_id}}/open
        GET {API}/lectures
        GET {API}/lectures/{{lecture_id}}
        POST {API}/lectures/{{lecture_id}}/cues/{{number}}
        POST GET {API}/votes
        GET DELETE {API}/votes/{{vote_id}}
        POST {API}/votes/{{vote_id}}/close
        POST {API}/votes/{{vote_id}}/reveal
        PUT {API}/votes/{{vote_id}}/hands
        POST GET {API}/classes
        GET DELETE {CLASS}
        POST DELETE {CLASS}/code
        GET {CLASS}/members
        DELETE {CLASS}/members/{{member_id}}
        DELETE {CLASS}/members/{{member_id}}/hand
        POST {CLASS}/commands
        POST {CLASS}/scenario
        POST {CLASS}/start
        PUT DELETE {CLASS}/shown
        PUT {CLASS}/layout
        GET {CLASS}/audit
        POST GET DELETE {CLASS}/blind
        GET {CLASS}/games/{{game_id}}
        GET {API}/instruments
        POST {API}/instruments/{{name}}/benches
        GET /metrics
        GET /class
        GET /runs
        GET /runs/{{run_ids}}
    """,
}

_TESTING_DOORS = {
    Need.TEACHER: f"""
        POST {API}/testing/advance  *
    """,
}

LTI = "/lti"
_LTI_DOORS = {
    # A launch proves by a signature who it is, or leads to a secret that works once; keys and addresses are public.
    # The page at LTI itself is the same for all, and shows nothing until it has exchanged such a secret.
    Need.NOTHING: f"""
        GET {LTI}
        GET POST {LTI}/login
        POST {LTI}/launch
        POST {LTI}/link
        POST {LTI}/session
        GET {LTI}/jwks
        GET {LTI}/configuration
    """,
    # A ticket opens what its holder may open anyway.
    Need.SESSION: f"""
        POST {LTI}/ticket  *
    """,
}


def _table(doors: Mapping[Need, str]) -> tuple[dict[Door, Need], set[Door]]:
    """Return the need of each door, and the doors that stay open while a fault is hidden."""
    needs: dict[Door, Need] = {}
    open_while_blind: set[Door] = set()
    for need, lines in doors.items():
        for line in filter(str.strip, lines.split("\n")):
            *methods, path = line.removesuffix("*").split()
            here = {(method, path): need for method in methods}
            needs |= here
            if line.endswith("*"):
                open_while_blind |= here.keys()
    return needs, open_while_blind


DOORS, _own = _table(_DOORS)
"""The need of each door, by its method and its path."""
LTI_DOORS, _of_platforms = _table(_LTI_DOORS)
"""The same for the doors that exist only where learning platforms are configured."""
TESTING_DOORS, _of_tests = _table(_TESTING_DOORS)
"""The same for the door that advances a manual clock; it exists only with that clock."""
OPEN_WHILE_BLIND = frozenset(_own | _of_platforms | _of_tests)
"""The doors marked ``*``: doors without a bench, and doors that serve the view of a bench with a hidden fault."""

ALL = {**DOORS, **LTI_DOORS, **TESTING_DOORS}
_PATTERNS = [(method, compile_path(path)[0], need, path) for (method, path), need in ALL.items()]
_PAGE = ("/api/", "/health/", "/benches/", "/metrics")
"""Below these, a path without an entry is no part of the page."""


def serves_blind(method: str, path: str) -> bool:
    """Return whether a door stays open while a fault is hidden on the bench of the caller."""
    asked = "GET" if method == "HEAD" else method
    for known, pattern, need, shape in _PATTERNS:
        if known == asked and pattern.match(path):
            return need is Need.NOTHING or (known, shape) in OPEN_WHILE_BLIND
    return asked == "GET" and not path.startswith(_PAGE)


def need_of(method: str, path: str) -> tuple[Need, str]:
    """Return the need of a request, and the bench in its path if it has one.

    Parameters
    ----------
    method : str
        Of HTTP, or ``SOCKET``.
    path : str
        As the router sees it.
    """
    asked = "GET" if method == "HEAD" else method
    for known, pattern, need, _ in _PATTERNS:
        if known == asked and (match := pattern.match(path)):
            return need, match.groupdict().get("bench_id", "")
    if asked == "GET" and not path.startswith(_PAGE):
        return Need.SESSION, ""  # the page and its files
    return Need.TEACHER, ""

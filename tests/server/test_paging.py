"""Lists page by page: one shape for all, no row twice, no row lost; only lists of a fixed length come whole."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Iterator
from datetime import timedelta
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

import httpx
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from server.api.paging import MOST
from server.app import create_app
from server.runs.listing import fresh
from server.settings import Settings
from server.store.base import now
from server.store.models import ParameterSetRow, RecordingRow

BASE = "/api/v1"
PART_OF_ONE = "parts of one thing or of one computation, which are of use together"
OF_THE_PROGRAM = "comes with the program, so that a version of it fixes the length"
OF_A_CLASS = "one row for each student, and the server has room for max_students"
WHOLE = {
    "get_catalog": OF_THE_PROGRAM,
    "get_devices": OF_THE_PROGRAM,
    "list_scenarios": OF_THE_PROGRAM,
    "get_gallery": OF_THE_PROGRAM,
    "list_benchmarks": OF_THE_PROGRAM,
    "list_lectures": OF_THE_PROGRAM,
    "list_games": OF_THE_PROGRAM,
    "list_schemas": OF_THE_PROGRAM,
    "list_captures": "at most 16 triggers with 50 captures each, constants of the program",
    "get_class_blind": OF_A_CLASS,
    "get_grades": OF_A_CLASS,
    "get_class_game": OF_A_CLASS,
    "get_game": OF_A_CLASS,
    **dict.fromkeys(
        (
            "get_scenario", "get_bench", "region", "plants", "flops", "explain_sample", "map_bench_aliases",
            "get_readout", "list_printed", "list_claims", "compare_parameter_sets", "get_recording", "get_run",
            "get_record_plot",
            "compare_finished_runs", "compare_traces", "get_sweep_distribution", "get_sweep_picture", "get_benchmark",
            "get_lecture", "get_class", "get_blind", "get_vote", "get_sheet",
        ),
        PART_OF_ONE,
    ),
}  # fmt: skip
"""Why an answer with a list in it has no pages."""


@pytest.fixture(scope="module")
def document(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    found: dict[str, Any] = create_app(Settings(data=tmp_path_factory.mktemp("data"))).openapi()
    return found


def listing(document: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Go through the operations that answer with a list, or with an object that has one."""

    def resolved(schema: dict[str, Any]) -> dict[str, Any]:
        while "$ref" in schema:
            schema = document["components"]["schemas"][schema["$ref"].rsplit("/", 1)[1]]
        return schema

    def is_list(schema: dict[str, Any]) -> bool:
        return any(resolved(one).get("type") == "array" for one in (schema, *schema.get("anyOf", ())))

    for path in document["paths"].values():
        schema = path.get("get", {}).get("responses", {}).get("200", {}).get("content", {}).get("application/json", {})
        whole = resolved(schema.get("schema", {}))
        if is_list(whole) or any(map(is_list, whole.get("properties", {}).values())):
            yield path["get"]


def test_each_list_has_pages_or_a_reason_to_have_none(document: dict[str, Any]) -> None:
    paged = {
        one["operationId"]: {parameter["name"]: parameter["schema"] for parameter in one["parameters"]}
        for one in listing(document)
        if "headers" in one["responses"]["200"]
    }
    whole = {one["operationId"] for one in listing(document)} - paged.keys()
    assert whole == WHOLE.keys(), "a list needs pages (server/api/paging.py) or a line in this table"
    for name, parameters in paged.items():
        limit = parameters["limit"]
        assert 1 == limit["minimum"] <= limit["default"] <= limit["maximum"], name
        assert {"type": "string", "maxLength": 500} in parameters["after"]["anyOf"], name
    unlike = {name for name, one in paged.items() if one["limit"]["maximum"] != MOST}
    assert unlike == {"list_events", "get_sweep_points"}  # these had larger pages before


class Rows(NamedTuple):
    """A list of the server, whose rows a test adds and removes."""

    name: str
    path: str
    add: Callable[[int], str]
    remove: Callable[[str], object]


def lists(live: Any) -> list[Rows]:
    """Return lists of each kind: in a table by age and by name, and in memory."""
    database = live.service.database
    bench = live.bench("first-look", paused=True)["id"]
    snapshots, born = f"{BASE}/benches/{bench}/snapshots", now()

    def put(row: Any) -> str:
        made: str = row.id
        live.on_loop(database.run(lambda session: session.add(row)))
        return made

    def aged(row: Any, at: int) -> str:
        row.created = born - timedelta(seconds=at)
        return put(row)

    def drop(kind: str) -> Callable[[str], object]:
        return lambda row_id: live.http.delete(f"{BASE}/{kind}/{row_id}").raise_for_status()

    def run(at: int) -> str:
        row = fresh(
            kind="run",
            key=secrets.token_hex(16),
            name="x",
            scenario_id="paged",
            title="",
            document={},
            seeds=[1],
            runs=1,
        )
        row.state = "done"
        return aged(row, at)

    def recording(at: int) -> str:
        values = {"name": "", "state": "failed", "title": "", "dt_ms": 1.0, "start_tick": 0, "signals": []}
        return aged(RecordingRow(id=secrets.token_hex(15), bench_id="paged", **values), at)

    def parameters(at: int) -> str:
        name = f"{at} {secrets.token_hex(3)}"
        return put(ParameterSetRow(id=secrets.token_hex(8), name=name, scenario="", values={}))

    def removed_run(row_id: str) -> object:
        return live.http.post(f"{BASE}/runs/remove", json={"ids": [row_id]}).raise_for_status()

    return [
        Rows("runs", f"{BASE}/runs?scenario=paged", run, removed_run),
        Rows("recordings", f"{BASE}/recordings", recording, drop("recordings")),
        Rows("sets", f"{BASE}/parameter-sets", parameters, drop("parameter-sets")),
        Rows(
            "snapshots",
            snapshots,
            lambda _: str(live.http.post(snapshots).json()["id"]),
            lambda row_id: live.http.delete(f"{snapshots}/{row_id}").raise_for_status(),
        ),
    ]


def following(answer: httpx.Response) -> str | None:
    """Return the address of the next page."""
    found: str | None = answer.links.get("next", {}).get("url")
    return found


CHANGES = st.lists(st.tuples(st.booleans(), st.integers(0, 6)), max_size=3)
"""Rows that are added at a place, or removed, between two pages."""


def test_pages_neither_repeat_nor_lose_a_row_while_others_come_and_go(live: Any) -> None:
    kinds = lists(live)

    @settings(max_examples=20, deadline=None, derandomize=True, suppress_health_check=list(HealthCheck))
    @given(st.sampled_from(kinds), st.integers(1, 3), st.lists(st.integers(0, 6), max_size=5), st.lists(CHANGES))
    def walk(rows: Rows, limit: int, places: list[int], between: list[list[tuple[bool, int]]]) -> None:
        for place in places:
            rows.add(place)
        there = [one["id"] for one in live.http.get(rows.path).json()[rows.name]]
        whole, lasting, seen = list(there), set(there), []
        changes = chain(between, iter(lambda: [], None))
        address: str | None = str(httpx.URL(rows.path).copy_merge_params({"limit": limit}))
        while address is not None:
            answer = live.http.get(address)
            page = [one["id"] for one in answer.json()[rows.name]]
            assert len(page) <= limit
            assert not set(page) & set(seen), "a row is on two pages"
            seen += page
            address = following(answer)
            assert len(page) == limit or address is None
            for comes, place in next(changes):
                if comes:
                    there.append(rows.add(place))
                elif there:
                    gone = there.pop(place % len(there))
                    rows.remove(gone)
                    lasting.discard(gone)
        assert lasting <= set(seen), "a row is on no page"
        assert [one for one in seen if one in lasting] == [one for one in whole if one in lasting]
        for row_id in there:
            rows.remove(row_id)

    walk()


def test_a_list_without_arguments_tells_whether_it_is_whole(live: Any) -> None:
    runs, recordings, *_ = lists(live)
    ids = [runs.add(0) for _ in range(210)]  # of the same moment
    made = [recordings.add(0) for _ in range(20)]
    whole = live.http.get(recordings.path)
    assert set(made) <= {one["id"] for one in whole.json()["recordings"]} and following(whole) is None
    for row_id in made:
        recordings.remove(row_id)
    part = live.http.get(f"{runs.path}&text=")
    rest = live.http.get(str(following(part)))
    assert len(part.json()["runs"]) == 200 and len(rest.json()["runs"]) == 10 and following(rest) is None
    assert {one["id"] for answer in (part, rest) for one in answer.json()["runs"]} == set(ids)
    live.http.post(f"{BASE}/runs/remove", json={"ids": ids})


def test_events_and_sentences_go_on_after_a_number(live: Any) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    for severity in (0.1, 0.2, 0.3):
        live.command(bench, fault="added_mass", severity=severity)
    events = f"{BASE}/benches/{bench}/events"
    whole = live.http.get(events).json()["events"]
    first = live.http.get(f"{events}?limit=2")
    assert first.json()["events"] == whole[:2] and "after=2" in str(following(first))
    assert live.http.get(str(following(first))).json()["events"] == whole[2:4]
    live.command(bench, "step", ticks=9000)
    told = f"{BASE}/benches/{bench}/narration"
    sentences, page = live.http.get(told).json(), live.http.get(f"{told}?limit=1")
    assert len(sentences["sentences"]) > 1 and page.json()["sentences"] == sentences["sentences"][:1]
    assert f"jumps={sentences['jumps']}" in str(following(page))
    assert live.http.get(str(following(page))).json()["sentences"] == sentences["sentences"][1:2]


@pytest.mark.parametrize(
    ("query", "field"),
    [("limit=0", "limit"), (f"limit={MOST + 1}", "limit"), ("limit=x", "limit"), ("after=x", "after"),
     ("after=1", "after"), ('after="2026-01-01","a"]', "after"), ("after=" + "9" * 600, "after")],
)  # fmt: skip
def test_a_page_that_cannot_be_is_refused_in_one_line(live: Any, query: str, field: str) -> None:
    for path in ("runs", "recordings", "links", "sweeps"):
        answer = live.http.get(f"{BASE}/{path}?{query}")
        assert answer.status_code == 422, answer.text
        error = answer.json()["error"]
        assert error["field"] == field and error["message"] and "\n" not in error["message"]


def test_the_next_page_is_where_the_caller_is(serve: Any, tmp_path: Path) -> None:
    with serve(public_origin="https://lab.example/bench", folder=tmp_path) as live:
        live.bench("first-look", paused=True), live.bench("first-look", paused=True)
        behind = live.http.get(f"{BASE}/benches?limit=1", headers={"Host": "lab.example"})
        assert str(following(behind)).startswith("https://lab.example/bench/api/v1/benches?limit=1&after=")
        direct = live.http.get(f"{BASE}/benches?limit=1")
        assert str(following(direct)).startswith(f"{live.address}/api/v1/benches?limit=1&after=")
        assert len(live.http.get(str(following(direct))).json()["benches"]) == 1

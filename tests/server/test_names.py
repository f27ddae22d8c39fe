"""Chosen names leave the server in many formats; each follows the rule of its readers."""

from __future__ import annotations

import csv
import importlib.util
import io
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import quote
from xml.etree import ElementTree

import numpy as np
import pyarrow.parquet as pq
import pytest
from scipy.io import loadmat

from scenarios.report.matlab import KEYWORDS
from tests.server.conftest import TOKEN

HOSTILE = ["m+5", "m,5", "a-b", "a_b", "Ω+5", "<b>&amp;", '"q"', "=1+1", "a/b", "x" * 24]
BANK = "bank_of_a_very_long_name_indeed0"
SCENARIO = {
    "id": "names",
    "sample_rate_khz": 100,
    "samples": 50,
    "device": {"id": "ch3"},
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 2000.0},
    "sensor": {"kind": "ideal", "noise_um": 0.05},
    "diagnosers": {
        BANK: {
            "kind": "mmae",
            "hypotheses": [{"name": "healthy"}, *({"name": name, "mass": 1.01 + 0.01 * place}
                                                  for place, name in enumerate(HOSTILE))],
        }
    },
}  # fmt: skip
SIGNALS = [f"{BANK}.probability.{name}" for name in HOSTILE]


@pytest.fixture(scope="module")
def ended(shared: Any) -> str:
    """A run whose signals have hostile names, by its id."""
    run = shared.http.post("/api/v1/runs", json={"scenario": SCENARIO}).json()
    shared.ended(run["id"])
    return str(run["id"])


def fetched(live: Any, address: str, **query: Any) -> bytes:
    answer = live.http.get(f"/api/v1{address}", params=query)
    assert answer.is_success, answer.text
    return bytes(answer.content)


def strict_rows(text: str) -> list[list[str]]:
    """Read CSV as RFC 4180 has it: nothing is forgiven, and all rows are as long as the first."""
    rows = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    assert {len(row) for row in rows} == {len(rows[0])}
    return rows


class Tags(HTMLParser):
    """The tags of a page, and the text between them."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: set[str] = set()
        self.said: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        self.tags.add(tag)

    def handle_data(self, data: str) -> None:
        self.said.append(data)


@pytest.mark.parametrize("name", SIGNALS)
def test_each_name_can_be_asked_for(live: Any, ended: str, name: str) -> None:
    address = f"/api/v1/runs/{ended}/trace?format=csv&signals={quote(name, safe='')}"
    answer = live.http.get(address)
    assert strict_rows(answer.text)[0] == ["tick", "time_ms", name]


def test_names_are_asked_for_one_by_one_or_between_commas(live: Any, ended: str) -> None:
    path = f"/runs/{ended}/trace"
    several = ["plant.displacement", "drive.voltage", SIGNALS[1]]
    head = strict_rows(fetched(live, path, format="csv", signals=several).decode())[0]
    assert head[2:] == several
    joined = fetched(live, path, format="csv", signals="plant.displacement, drive.voltage").decode()
    assert strict_rows(joined)[0][2:] == several[:2]


def test_comma_separated_values(live: Any, ended: str) -> None:
    head = strict_rows(fetched(live, f"/runs/{ended}/trace", format="csv").decode())[0]
    assert set(SIGNALS) <= set(head)


def test_matlab(live: Any, ended: str) -> None:
    file = loadmat(io.BytesIO(fetched(live, f"/runs/{ended}/trace", format="mat")))
    found = {name: values for name, values in file.items() if not name.startswith("__")}
    bad = [name for name in found if not re.fullmatch("[A-Za-z][A-Za-z0-9_]{0,62}", name) or name in KEYWORDS]
    assert bad == []
    beside = found.pop("names")
    names = {field: str(beside[field][0, 0][0]) for field in beside.dtype.names}
    assert names.keys() == found.keys() and set(SIGNALS) <= set(names.values())
    table = pq.read_table(io.BytesIO(fetched(live, f"/runs/{ended}/trace", format="parquet")))
    for variable, name in names.items():
        np.testing.assert_array_equal(found[variable][:, 0], table[name].to_numpy())


def test_numpy(live: Any, ended: str) -> None:
    with np.load(io.BytesIO(fetched(live, f"/runs/{ended}/trace", format="npz"))) as file:
        assert set(SIGNALS) <= set(file.files) and all(len(file[name]) == 50 for name in SIGNALS)


def test_pages_and_drawings(live: Any, ended: str) -> None:
    report = fetched(live, f"/runs/{ended}/report").decode()
    page = Tags(report)
    assert "b" not in page.tags and any("<b>&amp;" in said for said in page.said)
    for drawing in re.findall(r"<svg .*?</svg>", report, re.DOTALL):
        ElementTree.fromstring(drawing)
    ElementTree.fromstring(fetched(live, f"/runs/{ended}/thumbnail"))


def test_a_live_bench(live: Any) -> None:
    bench = live.bench(SCENARIO, paused=True)
    live.command(bench["id"], "step", ticks=20)
    path = f"/benches/{bench['id']}/trace"
    for kind in ("csv", "mat", "npz", "parquet"):
        assert fetched(live, path, format=kind)
        assert fetched(live, path, format=kind, signals=SIGNALS)
    assert list(live.http.get(f"/api/v1{path}", params={"signals": SIGNALS}).json()["signals"]) == SIGNALS


def test_the_client_of_python(live: Any, ended: str) -> None:
    place = Path(__file__).resolve().parents[2] / "clients" / "combbench_client.py"
    spec = importlib.util.spec_from_file_location("combbench_client_of_names", place)
    assert spec is not None and spec.loader is not None
    client = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(client)
    trace = client.Client(live.address, TOKEN).trace({"id": ended}, *SIGNALS)
    assert list(trace) == ["tick", "time_ms", *SIGNALS]


def test_rows_of_a_campaign(live: Any) -> None:
    variants = [
        {"name": name, "set": {"sensor.noise_um": 0.01 * place}}
        for place, name in enumerate(["m,5", 'a "b"', "line\nbreak"])
    ]
    document = {"id": "names", "scenario": {**SCENARIO, "diagnosers": {}}, "variants": variants}
    answer = live.http.post("/api/v1/sweeps", json={"sweep": document})
    assert answer.is_success, answer.text
    sweep = answer.json()
    live.ended(sweep["id"])
    rows = strict_rows(fetched(live, f"/sweeps/{sweep['id']}/runs", format="csv").decode())
    column = rows[0].index("variant")
    assert [row[column] for row in rows[1:]] == [one["name"] for one in variants]


@pytest.mark.parametrize("name", ["x" * 80, "a b", "a.b", "a\nb", "a\0b", "a\x1bb", ""])
def test_a_name_that_no_format_takes_is_refused(live: Any, name: str) -> None:
    bank = {"kind": "mmae", "hypotheses": [{"name": "healthy"}, {"name": name, "mass": 1.05}]}
    answer = live.http.post("/api/v1/benches", json={"scenario": {**SCENARIO, "diagnosers": {"kalman": bank}}})
    assert answer.status_code == 422 and "name" in answer.json()["error"]["field"], answer.text


@pytest.mark.parametrize("section", ["diagnosers", "twins", "units"])
def test_an_identifier_ends_where_it_ends(live: Any, section: str) -> None:
    answer = live.http.post("/api/v1/benches", json={"scenario": {**SCENARIO, section: {"kalman\n": {}}}})
    assert answer.status_code == 422 and "short name" in answer.json()["error"]["message"], answer.text


@pytest.mark.parametrize(
    ("path", "meant"),
    [
        ("scenarios/ch5-sevn-step", "ch5-seven-step"),
        ("gallery/ch5-sevn-step/figure", "ch5-seven-step"),
        ("lectures/ch5-diagnosi", "ch5-diagnosis"),
        ("sheets/first-lok", "first-look"),
        ("units/pidd", "pid"),
    ],
)
def test_an_unknown_name_brings_the_nearest(live: Any, path: str, meant: str) -> None:
    answer = live.http.get(f"/api/v1/{path}")
    assert answer.status_code == 404 and answer.json()["error"]["hint"] == f"did you mean {meant}?", answer.text

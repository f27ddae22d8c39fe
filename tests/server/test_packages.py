"""What leaves a bench carries the installed packages that it names: a saved scenario, a link."""

from __future__ import annotations

import tomllib
from importlib.metadata import EntryPoint
from typing import Any

import pytest

from core.board import packages
from tests.server.test_links import digest, opened, share

PID = EntryPoint("pid", "core.control.pid:Pid", "combbench.control")


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch) -> dict[str, packages.Package]:
    """Take the PID for a block of a package that is installed."""
    found = {"some-pid": packages.Package("1.0", (PID,))}
    monkeypatch.setattr(packages, "packages", lambda: found)
    return found


def test_what_was_switched_to_is_carried_and_refused_where_it_is_another(
    live: Any, installed: dict[str, packages.Package]
) -> None:
    bench = live.bench("first-look", paused=True)["id"]
    before = tomllib.loads(live.http.get(f"/api/v1/benches/{bench}/scenario").text)
    assert "packages" not in before
    live.command(bench, "step", ticks=50)
    assert live.command(bench, switch="pid").status_code == 200
    live.command(bench, "step", ticks=50)
    saved = tomllib.loads(live.http.get(f"/api/v1/benches/{bench}/scenario").text)
    mark = {"some-pid": {"version": "1.0", "source": installed["some-pid"].source}}
    assert saved["packages"] == mark
    link = share(live, bench=bench)
    assert digest(live, opened(live, link["id"])["id"]) == digest(live, bench)
    installed["some-pid"] = packages.Package("2.0", (PID,))
    refused = live.http.post(f"/api/v1/links/{link['id']}/open")
    line = "packages.some-pid: is version 2.0 here; this scenario was made with version 1.0"
    assert refused.status_code == 409 and line in refused.json()["error"]["message"]
    refused = live.http.post("/api/v1/runs", json={"scenario": saved})
    assert refused.status_code == 422 and refused.json()["error"]["field"].endswith("packages.some-pid")

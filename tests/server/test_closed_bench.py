"""A bench that was closed takes no command, neither a new command nor a waiting one."""

from __future__ import annotations

from typing import Any

import pytest

from server.bench.commands import parse
from server.errors import ApiError
from tests.server.test_bad_input import check


def test_a_bench_that_was_closed_takes_no_command(live: Any) -> None:
    bench = live.bench(paused=True)["id"]
    session = live.service.benches.find(bench)
    assert live.http.delete(f"/api/v1/benches/{bench}").status_code == 204
    for kind in ("start", "step", "undo", "reset_trip"):
        answer = live.command(bench, kind)
        check(answer, 404, "not_found", bench)
        with pytest.raises(ApiError) as late:  # its turn came after the end of the bench
            session.execute(parse({"kind": kind}), "test")
        body = late.value.body
        assert (late.value.status_code, body.code, body.message) == (
            404,
            "not_found",
            answer.json()["error"]["message"],
        )

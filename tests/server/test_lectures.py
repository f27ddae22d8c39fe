"""A lecture on the bench: each cue is the same bits, forwards and back, whatever was done in between."""

from __future__ import annotations

from typing import Any

import pytest

from scenarios.lectures import lecture, lecture_ids
from scenarios.run import run


def put(live: Any, name: str, number: int, bench: str | None = None) -> dict[str, Any]:
    answer = live.http.post(f"/api/v1/lectures/{name}/cues/{number}", json={"bench": bench})
    assert answer.status_code == 200, answer.text
    return dict(answer.json())


def digest(live: Any, bench: str) -> tuple[int, str]:
    found = live.http.get(f"/api/v1/benches/{bench}/digest").json()
    return found["tick"], found["digest"]


def test_lectures_are_listed_and_shown_with_their_notes(live: Any) -> None:
    listed = live.http.get("/api/v1/lectures").json()["lectures"]
    assert [one["id"] for one in listed] == list(lecture_ids())
    shown = live.http.get("/api/v1/lectures/ch5-diagnosis").json()
    assert shown["cues"] == len(shown["script"]) and shown["minutes"] == 10
    vote = shown["script"][1]
    assert vote["say"] and (vote["from_ms"], vote["until_ms"]) == (10, 24)
    assert vote["vote"]["diagnoser"] == "kalman"


def test_a_cue_is_the_same_bits_forwards_and_back_in_one_bench(live: Any) -> None:
    first = put(live, "ch5-diagnosis", 4)
    bench = first["bench"]["id"]
    assert first["bench"]["state"] == "paused" and digest(live, bench) == (first["tick"], first["digest"])
    forward = [first] + [put(live, "ch5-diagnosis", number, bench) for number in (5, 6)]
    assert live.command(bench, fault="damping", severity=0.5).status_code == 200  # a user changes the bench
    live.command(bench, "pause")
    back = [put(live, "ch5-diagnosis", number, bench) for number in (6, 5, 4)]
    assert [one["bench"]["id"] for one in forward + back] == [bench] * 6
    assert [one["digest"] for one in forward] == [one["digest"] for one in reversed(back)]
    assert len({one["digest"] for one in forward}) == 2  # cue 5 continues from the end of cue 4
    assert digest(live, bench) == (first["tick"], first["digest"])
    live.http.delete(f"/api/v1/benches/{bench}")


def test_a_cue_runs_to_its_end_and_is_what_a_run_gives(live: Any) -> None:
    bench = put(live, "ch5-diagnosis", 3)["bench"]
    assert bench["state"] == "running" and bench["time_scale"] == 0.0005
    live.command(bench["id"], "time_scale", value=None)
    state = lecture("ch5-diagnosis").states[2]
    live.until(bench["id"], lambda status: status["state"] == "paused")
    result = run(state.scenario)
    assert digest(live, bench["id"]) == (state.until_tick, result.digest)
    live.http.delete(f"/api/v1/benches/{bench['id']}")


@pytest.mark.parametrize("name", lecture_ids())
def test_a_lecture_goes_through_on_the_bench_to_its_end_and_back_with_the_same_bits(live: Any, name: str) -> None:
    cues = range(1, len(lecture(name).head.cues) + 1)
    digests: dict[int, str] = {}
    bench = None
    for number in (*cues, *reversed(cues)):
        staged = put(live, name, number, bench)
        if bench is not None and staged["bench"]["id"] != bench:
            live.http.delete(f"/api/v1/benches/{bench}")
        bench = staged["bench"]["id"]
        assert digests.setdefault(number, staged["digest"]) == staged["digest"]
    live.http.delete(f"/api/v1/benches/{bench}")


def test_a_bench_of_other_signals_is_left_alone_and_a_fresh_one_made(live: Any) -> None:
    mine = live.bench("first-look", paused=True)["id"]
    before = digest(live, mine)
    staged = put(live, "ch1-device", 1, mine)["bench"]
    assert staged["id"] != mine and digest(live, mine) == before
    assert put(live, "ch1-device", 10, staged["id"])["bench"]["id"] == staged["id"]
    for bench in (mine, staged["id"]):
        live.http.delete(f"/api/v1/benches/{bench}")


def test_pages_of_a_bench_read_it_anew_when_a_cue_is_of_another_scenario(live: Any) -> None:
    bench = put(live, "ch5-diagnosis", 5)["bench"]
    with live.stream(bench["id"]) as stream:
        assert stream.step()["bench"]["title"] == bench["title"]
        put(live, "ch5-diagnosis", 6, bench["id"])  # of the same scenario: the streams stay
        stream.settle()
        other = put(live, "ch5-diagnosis", 7, bench["id"])["bench"]
        assert stream.until_closed().code == 4205
    assert other["id"] == bench["id"] and (bench["dt_ms"], other["dt_ms"]) == (0.01, 0.02)
    with live.stream(bench["id"]) as stream:
        hello = stream.step()["bench"]
        assert (hello["title"], hello["dt_ms"]) == (other["title"], 0.02)
    live.http.delete(f"/api/v1/benches/{bench['id']}")


def test_what_there_is_not_is_refused_in_one_line(live: Any) -> None:
    def refused(path: str, **body: Any) -> tuple[int, str]:
        answer = live.http.post(f"/api/v1/lectures/{path}", json=body)
        return answer.status_code, answer.json()["error"]["message"]

    assert refused("ch9/cues/1")[0] == 404
    assert refused("ch1-device/cues/99") == (404, "there is no cue 99: ch1-device has 10")
    assert refused("ch1-device/cues/1", bench="nobody")[0] == 404
    assert live.http.get("/api/v1/lectures/ch9").status_code == 404

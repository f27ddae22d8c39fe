"""A successful request for each door that writes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from server.bench.commands import Step
from server.classroom.access import API, BENCH, CLASS, DOORS
from tests.scenarios.records.foreign import DT, draw
from tests.server.classroom.group import Somebody
from tests.server.conftest import Live
from tests.server.world import ASKED, CASE, World

GAME = f"{API}/games/fool-the-bank"
RUN = {"scenario": "first-look", "set": {"samples": 100}}
SWEEP = {"sweep": {"schema": 1, "id": "two", "scenario": "first-look", "set": {"samples": 100}, "seeds": "1:3"}}

_HEALTHY = draw(1, samples=2200)
RECORD = (
    b"time_ms,drive,displacement\n"
    + "\n".join(
        f"{DT * i},{u},{y}" for i, (u, y) in enumerate(zip(_HEALTHY.drive, _HEALTHY.displacement, strict=True))
    ).encode()
)

Asked = tuple[Somebody, dict[str, str], Any]
CASES: dict[tuple[str, str], Callable[[World], Asked]] = {}


def case(method: str, path: str) -> Any:
    """Return a request with which a door would succeed."""

    def put(made: Callable[[World], Asked]) -> Callable[[World], Asked]:
        CASES[method, path] = made
        return made

    return put


def of_teacher(method: str, path: str, body: Any = None, **ids: Callable[[World], str]) -> None:
    """Say how a door is asked by the teacher."""
    CASES[method, path] = lambda w: (w.teacher, {name: made(w) for name, made in ids.items()}, body)


def a_class(w: World) -> str:
    return str(w.group()["id"])


def with_two(w: World) -> str:
    group = w.group()
    for _ in "12":
        w.student(group)
    return str(group["id"])


def shown(w: World) -> str:
    group = a_class(w)
    w.ask("PUT", f"{API}/classes/{group}/shown", bench=w.bench())
    return group


def a_set(w: World) -> str:
    return str(w.ask("POST", f"{API}/benches/{w.bench()}/parameter-sets", name=f"set {w.bench()}")["id"])


def a_link(w: World) -> str:
    return str(w.ask("POST", f"{API}/links", bench=w.bench())["id"])


def a_run(w: World) -> str:
    return str(w.ask("POST", f"{API}/runs", **RUN)["id"])


def an_ended_run(w: World) -> str:
    run = a_run(w)
    w.ask("DELETE", f"{API}/runs/{run}")
    return run


def a_sweep(w: World) -> str:
    return str(w.ask("POST", f"{API}/sweeps", **SWEEP)["id"])


def own_sheet(w: World) -> str:
    return str(w.ask("POST", f"{API}/sheets", text=CASE)["id"])


def worked_sheet(w: World) -> str:
    return w.at_sheet(w.teacher, ASKED)


of_teacher("POST", f"{API}/benches", {"scenario": "first-look", "paused": True})
of_teacher("DELETE", BENCH, bench_id=World.bench)
of_teacher("PATCH", BENCH, {"name": "mine"}, bench_id=World.bench)
of_teacher("POST", f"{BENCH}/parameter-sets", {"name": "a set"}, bench_id=World.bench)
of_teacher("POST", f"{BENCH}/parameter-sets/{{set_id}}", bench_id=World.bench, set_id=a_set)
of_teacher("PATCH", f"{API}/parameter-sets/{{set_id}}", {"name": "another"}, set_id=a_set)
of_teacher("DELETE", f"{API}/parameter-sets/{{set_id}}", set_id=a_set)
of_teacher("POST", f"{BENCH}/recordings", {"name": "one"}, bench_id=World.bench)
of_teacher("DELETE", f"{API}/recordings/{{recording_id}}", recording_id=lambda w: w.recording(w.bench()))
of_teacher("POST", f"{BENCH}/watchers", {"hours": 1.0}, bench_id=World.bench)
of_teacher("POST", f"{API}/links", {"scenario": "first-look"})
of_teacher("PATCH", f"{API}/links/{{link_id}}", {"note": "other words"}, link_id=a_link)
of_teacher("DELETE", f"{API}/links/{{link_id}}", link_id=a_link)
of_teacher("POST", f"{API}/links/{{link_id}}/open", link_id=a_link)
of_teacher("POST", f"{API}/runs", RUN)
of_teacher("PATCH", f"{API}/runs/{{run_id}}", {"label": "named"}, run_id=a_run)
of_teacher("DELETE", f"{API}/runs/{{run_id}}", run_id=a_run)
of_teacher("POST", f"{API}/sweeps", SWEEP)
of_teacher("PATCH", f"{API}/sweeps/{{sweep_id}}", {"label": "named"}, sweep_id=a_sweep)
of_teacher("DELETE", f"{API}/sweeps/{{sweep_id}}", sweep_id=a_sweep)
of_teacher("POST", f"{API}/gallery/run", {"only": "ch1-step"})
of_teacher("POST", f"{API}/sheets", {"text": CASE})
of_teacher("DELETE", f"{API}/sheets/{{sheet_id}}", sheet_id=worked_sheet)
of_teacher("POST", f"{API}/sheets/{{sheet_id}}/begin", sheet_id=own_sheet)
of_teacher("DELETE", f"{API}/sheets/{{sheet_id}}/progress", sheet_id=worked_sheet)
of_teacher("POST", f"{API}/votes", {"text": "Which?", "answers": ["a", "b"]})
of_teacher("POST", f"{API}/votes/{{vote_id}}/close", vote_id=World.vote)
of_teacher("POST", f"{API}/votes/{{vote_id}}/reveal", vote_id=World.vote)
of_teacher("PUT", f"{API}/votes/{{vote_id}}/hands", {"counts": [1, 2]}, vote_id=World.vote)
of_teacher("DELETE", f"{API}/votes/{{vote_id}}", vote_id=World.vote)
of_teacher("POST", f"{API}/classes", {"name": "Tuesday"})
of_teacher("DELETE", CLASS, class_id=with_two)
of_teacher("POST", f"{CLASS}/code", {"minutes": 5}, class_id=a_class)
of_teacher("DELETE", f"{CLASS}/code", class_id=a_class)
of_teacher("POST", f"{CLASS}/commands", {"command": {"heal": "all"}}, class_id=with_two)
of_teacher("POST", f"{CLASS}/scenario", {"scenario": "first-look", "paused": True}, class_id=with_two)
of_teacher("POST", f"{CLASS}/start", {}, class_id=with_two)
of_teacher("DELETE", f"{CLASS}/shown", class_id=shown)
of_teacher("PUT", f"{CLASS}/layout", {"name": "lab"}, class_id=a_class)
of_teacher("POST", f"{CLASS}/blind", {"scenario": "first-look"}, class_id=with_two)


def a_record(w: World) -> str:
    return str(w.live.http.post(f"{API}/records", content=RECORD, params={"name": "one.csv"}).json()["id"])


@case("POST", f"{API}/records")
def _(w: World) -> Asked:
    return w.teacher, {"?": "?name=one.csv"}, RECORD


@case("POST", f"{API}/records/columns")
def _(w: World) -> Asked:
    return w.teacher, {"?": "?name=one.csv"}, RECORD


of_teacher("DELETE", f"{API}/records/{{record_id}}", record_id=a_record)
of_teacher("POST", f"{API}/records/{{record_id}}/calibration", {"end": 2000}, record_id=a_record)
of_teacher("POST", f"{API}/records/{{record_id}}/diagnosis", {"end": 2000}, record_id=a_record)


@case("POST", f"{API}/measured-devices")
def _(w: World) -> Asked:
    return w.teacher, {}, {"name": "mine", "record": a_record(w), "end": 2000}


@case("DELETE", f"{API}/measured-devices/{{device_id}}")
def _(w: World) -> Asked:
    body = {"name": "another", "record": a_record(w), "end": 2000}
    return w.teacher, {"device_id": str(w.ask("POST", f"{API}/measured-devices", **body)["id"])}, None


@case("POST", f"{BENCH}/recordings/{{recording_id}}/stop")
def _(w: World) -> Asked:
    bench = w.bench()
    return w.teacher, {"bench_id": bench, "recording_id": w.recording(bench, ended=False)}, None


@case("DELETE", f"{BENCH}/watchers/{{watcher_id}}")
def _(w: World) -> Asked:
    bench = w.bench()
    watcher = w.ask("POST", f"{API}/benches/{bench}/watchers", hours=1.0)["id"]
    return w.teacher, {"bench_id": bench, "watcher_id": watcher}, None


@case("POST", f"{BENCH}/reopen")
def _(w: World) -> Asked:
    service, bench = w.live.service, w.bench()
    w.live.on_loop(service.idling._let_go(service.benches.get(bench)))
    if service.benches.find(bench) is not None:  # it is unused from now on
        service.idling._seen[bench], service.idling._patience_s = -1e9, 1.0
        w.live.on_loop(service.idling._let_go(service.benches.get(bench)))
        service.idling._patience_s = 60.0 * service.settings.idle_minutes
    return w.teacher, {"bench_id": bench}, None


@case("POST", f"{API}/recordings/{{recording_id}}/replay")
def _(w: World) -> Asked:
    bench = w.bench()
    w.live.on_loop(w.live.service.benches.command(w.live.service.benches.get(bench), Step(ticks=20), "teacher"))
    return w.teacher, {"recording_id": _past(w, bench)}, {"paused": True}


@case("POST", f"{API}/recordings/{{recording_id}}/compare")
def _(w: World) -> Asked:
    bench = w.bench()
    w.live.on_loop(w.live.service.benches.command(w.live.service.benches.get(bench), Step(ticks=20), "teacher"))
    one = _past(w, bench)
    return w.teacher, {"recording_id": one}, {"other": one}


def _past(w: World, bench: str) -> str:
    made = w.ask("POST", f"{API}/benches/{bench}/recordings", ticks=0, past_ticks=10)["id"]
    w.live.wait(lambda: w.ask("GET", f"{API}/recordings/{made}")["state"] == "done")
    return str(made)


@case("POST", f"{API}/runs/remove")
def _(w: World) -> Asked:
    return w.teacher, {}, {"ids": [an_ended_run(w)]}


@case("POST", f"{API}/sweeps/remove")
def _(w: World) -> Asked:
    sweep = a_sweep(w)
    w.ask("DELETE", f"{API}/sweeps/{sweep}")
    return w.teacher, {}, {"ids": [sweep]}


@case("PUT", f"{API}/sheets/{{sheet_id}}/recordings/{{recording_id}}")
def _(w: World) -> Asked:
    ada = w.student()
    sheet = w.at_sheet(ada, ASKED)
    return ada, {"sheet_id": sheet, "recording_id": w.recording(ada.bench)}, None


def at_step(word: str, text: str, body: Any) -> None:
    """Return a request of a student at a step."""

    def made(w: World) -> Asked:
        ada = w.student()
        return ada, {"sheet_id": w.at_sheet(ada, text), "step_id": "first" if text is CASE else "ask"}, body

    CASES["POST", f"{API}/sheets/{{sheet_id}}/steps/{{step_id}}/{word}"] = made


at_step("answer", ASKED, {"answer": "1 Hz"})
at_step("hint", ASKED, None)
at_step("close", ASKED, None)
at_step("hide", CASE, None)


@case("POST", f"{CLASS}/sheet")
def _(w: World) -> Asked:
    return w.teacher, {"class_id": with_two(w)}, {"sheet": own_sheet(w)}


def at_game(word: str, body: dict[str, Any]) -> None:
    """Return a request of a player at a game."""

    def made(w: World) -> Asked:
        ada = w.student()
        kinds = w.ask("GET", f"{GAME}?seed=1", ada)["kinds"]
        handed = {"hand_in": {"fault": kinds[0]["name"], "severity": 0.01}} if word == "attempts" else {}
        return ada, {"game_id": "fool-the-bank"}, {**body, **handed}

    CASES["POST", f"{API}/games/{{game_id}}/{word}"] = made


at_game("begin", {"seed": 1})
at_game("attempts", {"seed": 1})
at_game("reveal", {"seed": 1})


@case("PUT", f"{API}/me/hand")
def _(w: World) -> Asked:
    return w.student(), {}, {"raised": True}


@case("PUT", f"{API}/me/vote")
def _(w: World) -> Asked:
    group = w.group()
    return w.student(group), {}, {"vote": w.vote(class_id=group["id"]), "answer": 1}


@case("POST", f"{CLASS}/join")
def _(w: World) -> Asked:
    group = w.group()
    w.ask("POST", f"{API}/classes/{group['id']}/sheet", sheet=own_sheet(w))
    return Somebody(w.live, "nobody's"), {"class_id": group["id"]}, {"code": group["code"], "name": "Ben"}


def of_member(method: str, path: str) -> None:
    """Say how the teacher does something to a student."""

    def made(w: World) -> Asked:
        group = w.group()
        ada = w.student(group)
        w.ask("PUT", f"{API}/me/hand", ada, raised=True)
        w.blind(ada)
        return w.teacher, {"class_id": group["id"], "member_id": ada.id}, None

    CASES[method, path] = made


of_member("DELETE", f"{CLASS}/members/{{member_id}}")
of_member("DELETE", f"{CLASS}/members/{{member_id}}/hand")


@case("PUT", f"{CLASS}/shown")
def _(w: World) -> Asked:
    return w.teacher, {"class_id": a_class(w)}, {"bench": w.bench()}


@case("DELETE", f"{CLASS}/blind")
def _(w: World) -> Asked:
    group = w.group()
    for _ in "12":
        w.blind(w.student(group))
    return w.teacher, {"class_id": group["id"]}, None


def at_blind(method: str, path: str, body: Any, hidden: bool) -> None:
    """Say how a student does something at a hidden fault."""

    def made(w: World) -> Asked:
        ada = w.student()
        if hidden:
            w.blind(ada)
        return ada, {"bench_id": ada.bench}, body

    CASES[method, path] = made


at_blind("POST", f"{BENCH}/blind", {"seed": 2}, hidden=False)
at_blind("POST", f"{BENCH}/blind/answer", {"said": "m+5", "confidence": 0.5}, hidden=True)
at_blind("DELETE", f"{BENCH}/blind", None, hidden=True)

WITHOUT = {
    (method, path)
    for method, path in DOORS
    if path.startswith((f"{API}/theory", f"{API}/devices", f"{API}/scenarios", f"{API}/units", f"{API}/thresholds"))
    or path.startswith((f"{BENCH}/commands", f"{BENCH}/snapshots", f"{BENCH}/driving", f"{BENCH}/fork"))
    or path
    in (f"{BENCH}/variant", f"{BENCH}/identification", f"{BENCH}/diagnosers/{{name}}/aliases", f"{API}/qr", "/join")
    or path in (f"{API}/lectures/{{lecture_id}}/cues/{{number}}", f"{API}/instruments/{{name}}/benches")
}
"""Doors that ask no database, or the same as others: a search as a run, a bench on an instrument as any bench, the
page to join as the door of the class."""
AFTER_ALL: dict[tuple[str, str], Callable[[Live, dict[str, str]], bool]] = {
    ("POST", f"{BENCH}/recordings/{{recording_id}}/stop"): lambda live, ids: (
        not live.service.benches.get(ids["bench_id"]).recordings.under_way
    ),
    ("DELETE", f"{API}/runs/{{run_id}}"): lambda live, ids: _has_ended(live, f"runs/{ids['run_id']}"),
    ("DELETE", f"{API}/sweeps/{{sweep_id}}"): lambda live, ids: _has_ended(live, f"sweeps/{ids['sweep_id']}"),
    ("POST", f"{API}/gallery/run"): lambda live, _: len(live.http.get(f"{API}/runs").json()["runs"]) == 1,
}
"""Doors that act, then read the result: if that read fails, all of the action is done."""


def _has_ended(live: Live, path: str) -> bool:
    return bool(live.http.get(f"{API}/{path}").json()["state"] == "cancelled")

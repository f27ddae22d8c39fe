"""Games over REST: the points of the command line, the table and whom it tells what, limits, and benches that hide."""

from __future__ import annotations

import json
import random
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from threading import Event
from types import SimpleNamespace
from typing import Any

import pytest
from sqlalchemy import select

from scenarios.campaign.executor import Processes
from scenarios.games import GAMES, states
from scenarios.games.states import HiddenState
from server.store.people import GameAttemptRow
from tests.server.classroom.group import Somebody, join, open_class, the_teacher, watcher
from tests.server.classroom.test_blind_doors import BEFORE, LONG, fetched, run, streamed
from tests.server.classroom.test_blind_doors import live as still  # noqa: F401  (a fixture)
from tests.server.conftest import Live

FILTER, FOOL = "/api/v1/games/be-the-filter", "/api/v1/games/fool-the-bank"


def post(somebody: Somebody, path: str, status: int = 200, **body: Any) -> dict[str, Any]:
    answer = somebody.ask("POST", path, json=body)
    assert answer.status_code == status, answer.text
    found: dict[str, Any] = answer.json()
    return found


def look(somebody: Somebody, path: str, seed: int) -> dict[str, Any]:
    answer = somebody.ask("GET", f"{path}?seed={seed}")
    assert answer.status_code == 200, answer.text
    found: dict[str, Any] = answer.json()
    return found


@pytest.fixture(autouse=True)
def judge(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Judge in a thread of the server: a process of its own takes seconds to start."""
    with ThreadPoolExecutor(1) as thread:
        monkeypatch.setattr(Processes, "submit", lambda _, *work: thread.submit(*work))
        yield monkeypatch


@pytest.mark.parametrize("apart", [False, pytest.param(True, marks=pytest.mark.long)])
def test_the_points_are_those_of_the_command_line(live: Live, judge: pytest.MonkeyPatch, apart: bool) -> None:
    if apart:
        judge.undo()
    alone, seed = the_teacher(live), 7 if apart else 6
    values = {"assumed_noise_scale": 2.0, "mass": 1.1}
    shown = post(alone, f"{FILTER}/attempts", 201, seed=seed, hand_in=values)
    game = GAMES["be-the-filter"]
    outcome = game.judge(seed, game.read(seed, values))
    assert [one["outcome"] for one in shown["attempts"]] == [json.loads(outcome.model_dump_json())]
    assert shown["best"] == outcome.points and shown["left"] == 4 and shown["hidden"] is None
    kind = GAMES["fool-the-bank"].kinds(seed)[0]
    named = {"fault": kind.name, "severity": 0.01}
    shown = post(alone, f"{FOOL}/attempts", 201, seed=seed, hand_in=named)
    game = GAMES["fool-the-bank"]
    outcome = game.judge(seed, game.read(seed, named))
    assert [one["outcome"] for one in shown["attempts"]] == [json.loads(outcome.model_dump_json())]
    assert shown["left"] == 0 and shown["hidden"] == [fact.model_dump() for fact in game.hidden(seed)]


def test_the_list_says_rules_knobs_and_limits(live: Live) -> None:
    cards = {one["id"]: one for one in the_teacher(live).ask("GET", "/api/v1/games").json()["games"]}
    assert [*cards] == [*GAMES]
    knobs = {one["name"]: one for one in cards["be-the-filter"]["hand_in"]}
    assert (knobs["process_noise_v"]["unit"], knobs["probability_floor"]["maximum"]) == ("V", 0.05)
    assert cards["be-the-filter"]["live"] == ["assumed_noise_scale", "process_noise_v", "probability_floor"]
    assert all(one["rule"] and one["equations"] for one in cards.values())


def test_a_class_has_games_of_its_own_and_a_table_that_keeps_secrets(live: Live) -> None:
    group, other = open_class(live), open_class(live, "Friday")
    ada, bob, eve = join(live, group, "Ada"), join(live, group, "Bob"), join(live, other, "Eve")
    master = the_teacher(live)
    first = post(ada, f"{FILTER}/attempts", 201, seed=1, hand_in={"assumed_noise_scale": 3.0})
    own = post(bob, f"{FILTER}/attempts", 201, seed=1, hand_in={"assumed_noise_scale": 3.0})
    assert first["attempts"][0]["outcome"] != own["attempts"][0]["outcome"]  # each has a game of their own
    others = post(eve, f"{FILTER}/attempts", 201, seed=1, hand_in={"assumed_noise_scale": 3.0})
    assert others["best"] != own["best"] and [line["name"] for line in others["table"]] == ["Eve"]
    assert look(master, FILTER, 1)["table"] == []  # of players outside classes

    better = post(bob, f"{FILTER}/attempts", 201, seed=1, hand_in={"assumed_noise_scale": 3.0})
    ranked = better["table"]
    assert [line["points"] for line in ranked] == sorted((line["points"] for line in ranked), reverse=True)
    ties = [line["at"] for line in ranked if line["name"] == "Bob"]
    assert len(ties) == 2 and ties == sorted(ties)  # of the same points the earlier is first
    for line in ranked:
        assert line["mine"] == (line["name"] == "Bob") and (line["handed_in"] is None) == (line["name"] == "Ada")
    done = post(bob, f"{FILTER}/reveal", 200, seed=1)
    assert all(line["handed_in"] is not None for line in done["table"]) and done["left"] == 0
    assert look(ada, FILTER, 1)["hidden"] is None  # it is not over for her

    seen = look(master, f"/api/v1/classes/{group['id']}/games/be-the-filter", 1)
    assert {line["name"] for line in seen["table"]} == {"Ada", "Bob"} and all(one["handed_in"] for one in seen["table"])
    game, games = GAMES["be-the-filter"], {one["name"]: one for one in seen["students"]}
    number = games["Ada"]["draw"]
    again = game.judge(number, game.read(number, {"assumed_noise_scale": 3.0}))
    assert again.points == first["attempts"][0]["outcome"]["points"]
    for one in games.values():
        assert one["hidden"] == [fact.model_dump() for fact in game.hidden(one["draw"])]
    assert done["hidden"] == games["Bob"]["hidden"] != games["Ada"]["hidden"]
    live.http.delete(f"/api/v1/classes/{group['id']}/members/{ada.id}")
    assert {line["name"] for line in look(bob, FILTER, 1)["table"]} == {"Bob"}
    assert live.http.delete(f"/api/v1/classes/{group['id']}").status_code == 204
    kept = live.service.database.transact(lambda session: [row.name for row in session.scalars(select(GameAttemptRow))])
    assert "Eve" in kept and not {"Ada", "Bob"} & {*kept}  # the answers of a class go with it
    live.http.delete(f"/api/v1/classes/{other['id']}")


def test_a_second_name_is_told_nothing_of_the_game_of_the_first(live: Live, group: dict[str, Any]) -> None:
    ada, again = join(live, group, "Ada"), join(live, group, "Ada again")
    for path in (FILTER, FOOL):
        told = post(again, f"{path}/reveal", 200, seed=4)["hidden"]
        assert look(ada, path, 4)["hidden"] is None
        assert post(ada, f"{path}/reveal", 200, seed=4)["hidden"] != told
    benches = [post(one, f"{FILTER}/begin", 201, seed=5)["bench"] for one in (ada, again)]
    documents = [live.service.benches.get(bench).scenario.document for bench in benches]
    assert documents[0]["device"] != documents[1]["device"] and documents[0]["seed"] != documents[1]["seed"]


def test_attempts_are_limited_and_refused_in_one_line(
    live: Live, group: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    ada = join(live, group, "Ada")
    for left in (4, 3, 2, 1, 0):
        assert post(ada, f"{FILTER}/attempts", 201, seed=2, hand_in={})["left"] == left
    refused = post(ada, f"{FILTER}/attempts", 409, seed=2, hand_in={})["error"]
    assert refused["message"] == "you have no attempt left at seed 2" and refused["code"] == "limit"
    assert len(look(ada, FILTER, 2)["attempts"]) == 5 and look(ada, FILTER, 2)["hidden"] is not None
    post(ada, f"{FILTER}/reveal", 200, seed=3)
    assert post(ada, f"{FILTER}/attempts", 409, seed=3, hand_in={})["error"]["code"] == "limit"
    wrong = post(ada, f"{FILTER}/attempts", 422, seed=4, hand_in={"mass": 9.0})["error"]
    assert wrong["field"] == "mass" and "must be <= 2" in wrong["message"]
    assert post(ada, f"{FILTER}/attempts", 422, seed=4, hand_in={"weight": 1.0})["error"]["field"] == "weight"
    assert ada.ask("GET", "/api/v1/games/chess").status_code == 422
    assert look(ada, FILTER, 4)["left"] == 5  # refused answers do not count
    onlooker = watcher(live, ada.bench)
    assert onlooker.ask("GET", f"{FILTER}?seed=1").status_code == 409
    monkeypatch.setattr(live.service.games, "_is_open", False)
    assert post(ada, f"{FILTER}/attempts", 409, seed=4, hand_in={})["error"]["code"] == "runs_disabled"


class Waiting(Executor):
    """Judges nothing before the test allows it."""

    def __init__(self) -> None:
        self.asked, self.told = Event(), Future[Any]()

    def submit(self, judged: Any, *what: Any) -> Any:  # type: ignore[override]
        self.work = lambda: self.told.set_result(judged(*what))
        self.asked.set()
        return self.told


def test_nobody_hands_in_twice_at_once(live: Live, group: dict[str, Any], judge: pytest.MonkeyPatch) -> None:
    ada, waiting = join(live, group, "Ada"), Waiting()
    judge.setattr(Processes, "submit", lambda _, *work: waiting.submit(*work))
    hand_in = {"fault": look(ada, FOOL, 1)["kinds"][0]["name"], "severity": 0.01}
    with ThreadPoolExecutor(1) as thread:
        first = thread.submit(post, ada, f"{FOOL}/attempts", 201, seed=1, hand_in=hand_in)
        assert waiting.asked.wait(60)
        for door, body in (("attempts", {"hand_in": hand_in}), ("reveal", {})):
            refused = post(ada, f"{FOOL}/{door}", 409, seed=1, **body)["error"]
            assert refused["code"] == "conflict" and "still judged" in refused["message"]
        waiting.work()
        assert len(first.result(60)["table"]) == 1


def test_a_game_is_kept_over_the_end_of_the_server(serve: Any) -> None:
    with serve() as live:
        group = open_class(live)
        ada = join(live, group, "Ada")
        begun = post(ada, f"{FILTER}/begin", 201, seed=1, hand_in={"assumed_noise_scale": 2.0})
        post(ada, f"{FILTER}/attempts", 201, seed=1, hand_in={})
    with serve() as live:
        ada = Somebody(live, ada.secret, begun["bench"])
        shown = look(ada, FILTER, 1)
        assert len(shown["attempts"]) == 1 and shown["bench"] == begun["bench"]
        bench = ada.ask("GET", f"/api/v1/benches/{ada.bench}").json()
        assert bench["blind"]["game"] == {"game": "be-the-filter", "seed": 1} and bench["pending"] == []


def test_on_the_bench_of_the_filter_only_the_knobs_turn(live: Live, group: dict[str, Any]) -> None:
    ada = join(live, group, "Ada")
    ada.bench = post(ada, f"{FILTER}/begin", 201, seed=1, hand_in={"mass": 1.2})["bench"]
    path = f"/api/v1/benches/{ada.bench}"
    names = ada.ask("GET", path).json()["diagnosers"]["kalman"]["names"]
    assert names == ["healthy", "m+5", "m+10", "k+5", "b+30", "sixth"]
    knobs = {f"diagnosers.kalman.{name}": 2.0 for name in ("assumed_noise_scale", "process_noise_v")}
    assert ada.ask("POST", f"{path}/commands", json={"set": knobs}).status_code == 200
    told = ada.ask("GET", path).json()["parameters"]
    assert told["diagnosers"]["kalman"]["process_noise_v"] == 2.0 and "noise_um" not in told["sensor"]
    forbidden = (
        {"set": {"sensor.noise_um": 0.1}},
        {"set": {"diagnosers.kalman.sensor_noise_um": 0.1}},
        {"heal": "all"},
        {"fault": "added_mass", "severity": 0.1},
        {"kind": "reset", "values": {}},
        {"set": {"diagnosers.kalman.process_noise_v": 1.0}, "when": "plant.displacement > 0"},
    )
    for command in forbidden:
        refused = ada.ask("POST", f"{path}/commands", json=command)
        assert refused.status_code == 403 and refused.json()["error"]["code"] == "blind", command
    for door in ("blind/answer", "blind"):  # it cannot be ended as a question of blind diagnosis
        method = "POST" if door == "blind/answer" else "DELETE"
        body = {"json": {"said": "healthy", "confidence": 0.5}} if method == "POST" else {}
        assert ada.ask(method, f"{path}/{door}", **body).status_code == 409
    assert ada.ask("GET", f"{path}/scenario").status_code == 403
    swept = ada.ask("POST", f"{path}/identification", json={})
    assert swept.status_code == 403 and "no part of the game" in swept.json()["error"]["message"]
    post(ada, f"{FILTER}/reveal", 200, seed=1)
    assert ada.ask("GET", f"{path}/scenario").status_code == 200
    left = ada.ask("POST", "/api/v1/benches", json={"scenario": "first-look"})
    assert left.status_code == 201 and left.json()["blind"] is None


def test_on_the_bench_of_fool_the_bank_faults_are_tried_and_healed(live: Live, group: dict[str, Any]) -> None:
    ada = join(live, group, "Ada")
    ada.bench = post(ada, f"{FOOL}/begin", 201, seed=3)["bench"]
    path = f"/api/v1/benches/{ada.bench}"
    kinds = [kind["name"] for kind in look(ada, FOOL, 3)["kinds"]]
    for kind in kinds:
        assert ada.ask("POST", f"{path}/commands", json={"fault": kind, "severity": 0.2}).status_code == 200
    assert [one["name"] for one in ada.ask("GET", path).json()["faults"]] == sorted(
        kinds, key=[one["name"] for one in live.get(ada.bench)["faults"]].index
    )
    assert ada.ask("POST", f"{path}/commands", json={"heal": "all"}).status_code == 200
    kinds_of_events = [one["kind"] for one in ada.ask("GET", f"{path}/events").json()["events"]]
    assert kinds_of_events.count("inject") == 3 and "heal" in kinds_of_events
    other = next(name for name in ("added_mass", "stiffness", "damping", "drive_gain") if name not in kinds)
    assert ada.ask("POST", f"{path}/commands", json={"fault": other, "severity": 0.2}).status_code == 403
    assert ada.ask("POST", "/api/v1/benches", json={"scenario": "first-look"}).status_code == 201  # a game may be left


def test_somebody_alone_plays_too_and_has_one_bench_of_it(live: Live) -> None:
    alone = the_teacher(live)
    first = post(alone, f"{FILTER}/begin", 201, seed=1)["bench"]
    second = post(alone, f"{FOOL}/begin", 201, seed=1)["bench"]
    there = [bench["id"] for bench in live.http.get("/api/v1/benches").json()["benches"]]
    assert second in there and first not in there
    assert live.http.get(f"/api/v1/benches/{second}").json()["blind"]["game"]["game"] == "fool-the-bank"
    post(alone, f"{FOOL}/reveal", 200, seed=1)
    assert live.http.get(f"/api/v1/benches/{second}").json()["blind"] is None


@pytest.mark.parametrize("count", [2, pytest.param(6, marks=pytest.mark.long)])
@pytest.mark.parametrize("game", [FILTER, FOOL])
def test_every_door_says_the_same_of_every_game(
    still: Live,  # noqa: F811
    game: str,
    count: int,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Except for the samples, by which the game is played, and the sentences about the verdicts of the bank."""
    live = still
    monkeypatch.setattr("server.classroom.games.secrets", SimpleNamespace(token_hex=lambda n: "e" * 2 * n))
    unseen = ("plant.displacement", "kalman.truth", "kalman.delay", "faults.added_mass", "effects.mass_scale", "a.b")
    monkeypatch.setattr("tests.server.classroom.test_blind_doors.FORBIDDEN", unseen)
    ada = join(live, open_class(live), "Ada")
    chance, first, drawn = random.Random(1), {}, set()
    by_number = GAMES["fool-the-bank"].kinds
    monkeypatch.setattr(type(GAMES["fool-the-bank"]), "kinds", lambda _, __: by_number(1))  # these are public
    for _ in range(count):
        number = chance.randrange(2**31)
        monkeypatch.setattr("server.classroom.classes.draw", lambda *_, n=number: n)
        ada.bench = post(ada, f"{game}/begin", 201, seed=1)["bench"]
        seen = ada.ask("GET", f"/api/v1/benches/{ada.bench}").json()
        hidden = live.service.benches.get(ada.bench).scenario.document
        drawn.add(json.dumps([hidden["device"], hidden["sensor"], hidden["seed"]]))
        assert seen["blind"]["game"]["seed"] == 1
        got: dict[str, str] = {}
        for tick in (BEFORE, states.FIRST + states.EACH + 100):
            run(live, ada.bench, tick)
            walk = {
                **fetched(ada, LONG | {("POST", "/api/v1/benches")}),
                **{f"socket {key}": text for key, text in streamed(ada).items()},
            }
            got |= {f"{tick} {key}": text for key, text in walk.items() if "narration" not in key}
        first = first or got
        assert [(key, got[key], first[key]) for key in got if got[key] != first[key]] == []
        text = json.dumps(got)
        secrets = [hidden["sensor"]["noise_um"], hidden["seed"]]
        secrets += [value for name, value in hidden["device"].items() if name not in ("id", "bias_v")]
        assert not [value for value in secrets if str(value) in text]
    assert len(drawn) == count


def test_the_hidden_states_are_not_among_the_events(live: Live, group: dict[str, Any]) -> None:
    ada = join(live, group, "Ada")
    ada.bench = post(ada, f"{FILTER}/begin", 201, seed=1)["bench"]
    master = the_teacher(live)
    run(live, ada.bench, states.FIRST + states.EACH + 10)
    path = f"/api/v1/benches/{ada.bench}"
    whole = {one["kind"] for one in master.ask("GET", f"{path}/events").json()["events"]}
    assert "inject" in whole or HiddenState(draw_of(live, ada)).states[1] == 0
    assert not {"inject", "heal", "scheduled"} & {
        one["kind"] for one in ada.ask("GET", f"{path}/events").json()["events"]
    }


def draw_of(live: Live, student: Somebody) -> int:
    """Return the number that a student's game is drawn from."""
    person = live.service.people.by_secret(student.secret)
    shown = live.http.get(f"/api/v1/classes/{person.class_id}/games/be-the-filter?seed=1").json()
    return next(int(one["draw"]) for one in shown["students"] if one["name"] == person.name)

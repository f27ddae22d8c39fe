"""A vote: one answer of each student, which can be changed, and which is secret before it is revealed."""

from __future__ import annotations

from typing import Any

from sqlalchemy import select

from server.store.people import BallotRow, VoteRow
from tests.server.classroom.group import Somebody, join, on_loop, open_class
from tests.server.conftest import Live

LANES = {
    "text": "Which lane rises, and when?",
    "answers": ["healthy", "m+5", "k+5"],
    "diagnoser": "kalman",
    "when": {"from_ms": 20, "until_ms": 30},
    "right": "m+5",
}


def ask(live: Live, status: int = 201, **fields: Any) -> dict[str, Any]:
    answer = live.http.post("/api/v1/votes", json={**LANES, **fields})
    assert answer.status_code == status, answer.text
    return dict(answer.json())


def cast(student: Somebody, vote: str, answer: int, at_ms: float | None = 25.0) -> tuple[int, dict[str, Any]]:
    reply = student.ask("PUT", "/api/v1/me/vote", json={"vote": vote, "answer": answer, "at_ms": at_ms})
    return reply.status_code, reply.json()


def mine(student: Somebody) -> dict[str, Any]:
    return dict(student.me()["vote"])


def test_a_vote_from_the_question_to_what_was_said(live: Live, group: dict[str, Any]) -> None:
    ada, ben = join(live, group, "Ada"), join(live, group, "Ben")
    assert ada.me()["vote"] is None
    vote = ask(live, class_id=group["id"])
    seen = mine(ada)
    assert seen["question"]["answers"] == LANES["answers"] and seen["mine"] is None and seen["right"] is None
    assert cast(ada, vote["id"], 0)[0] == 200
    assert cast(ada, vote["id"], 1, 24.0)[1]["mine"] == {"answer": 1, "at_ms": 24.0}  # changed
    assert cast(ben, vote["id"], 2, 28.0)[0] == 200

    # before it is revealed: how many, and one's own
    hidden = live.http.get(f"/api/v1/votes/{vote['id']}").json()
    assert (hidden["voted"], hidden["results"], hidden["right"]) == (2, None, None)
    assert [one["results"] for one in live.http.get("/api/v1/votes").json()["votes"]] == [None]
    assert mine(ben)["mine"] == {"answer": 2, "at_ms": 28.0} and mine(ben)["results"] is None
    for path in (f"/api/v1/votes/{vote['id']}", "/api/v1/votes"):
        assert ada.ask("GET", path).status_code == 403
    assert "Ada" not in str(hidden)

    closed = live.http.post(f"/api/v1/votes/{vote['id']}/close").json()
    assert closed["state"] == "closed" and closed["results"] is None
    assert cast(ada, vote["id"], 0)[0] == 409
    shown = live.http.post(f"/api/v1/votes/{vote['id']}/reveal").json()
    assert shown["results"] == [{"count": 0, "at_ms": []}, {"count": 1, "at_ms": [24]}, {"count": 1, "at_ms": [28]}]
    assert shown["right"] == "m+5" == mine(ada)["right"]
    assert live.http.post(f"/api/v1/votes/{vote['id']}/close").json()["state"] == "revealed"


def test_one_vote_of_a_class_is_open_at_a_time(live: Live, group: dict[str, Any]) -> None:
    first = ask(live, class_id=group["id"])
    assert ask(live, 409, class_id=group["id"])["error"]["message"] == "a vote is open already"
    live.http.post(f"/api/v1/votes/{first['id']}/reveal")
    second = ask(live, class_id=group["id"])
    assert [one["id"] for one in live.http.get("/api/v1/votes").json()["votes"]] == [second["id"]]
    assert live.http.delete(f"/api/v1/votes/{second['id']}").status_code == 204
    assert live.http.get(f"/api/v1/votes/{second['id']}").status_code == 404


def test_hands_in_the_room_are_counted_by_the_teacher(live: Live, group: dict[str, Any]) -> None:
    vote = ask(live)
    assert vote["class_id"] is None
    put = lambda counts: live.http.put(f"/api/v1/votes/{vote['id']}/hands", json={"counts": counts})  # noqa: E731
    assert put([1, 12, 4]).json()["voted"] == 17
    assert put([1, 2]).json()["error"]["field"] == "counts"
    assert put([1, -2, 3]).status_code == 422
    shown = live.http.post(f"/api/v1/votes/{vote['id']}/reveal").json()
    assert [one["count"] for one in shown["results"]] == [1, 12, 4]
    student = join(live, group, "Ada")
    assert cast(student, vote["id"], 1)[0] == 404  # not of the student's class
    live.http.delete(f"/api/v1/votes/{vote['id']}")


def test_what_cannot_be_asked_or_answered_is_refused(live: Live, group: dict[str, Any]) -> None:
    def field(**fields: Any) -> str:
        return str(ask(live, 422, class_id=group["id"], **fields)["error"]["field"])

    assert field(answers=["one"]) == "answers"
    assert field(answers=["one", "one"]) == "answers"
    assert field(answers=list("abcdefg"), diagnoser="", right="") == "answers"
    assert field(right="b+30") == "right"
    assert field(when={"from_ms": 3, "until_ms": 3}) == "when"
    assert ask(live, 404, class_id="nobody")["error"]["code"] == "not_found"
    student = join(live, group, "Ada")
    vote = ask(live, class_id=group["id"])["id"]
    assert cast(student, vote, 3)[1]["error"]["field"] == "answer"
    assert cast(student, vote, 1, 31.0)[1]["error"]["field"] == "at_ms"
    assert cast(student, vote, 1, None)[1]["error"]["field"] == "at_ms"
    assert live.http.put("/api/v1/me/vote", json={"vote": vote, "answer": 0}).status_code == 403


def test_ballots_go_with_the_student_and_the_vote_with_the_class(live: Live) -> None:
    async def rows() -> tuple[int, int]:
        read = live.service.database.run
        votes = await read(lambda session: len(list(session.scalars(select(VoteRow)))))
        return votes, await read(lambda session: len(list(session.scalars(select(BallotRow)))))

    group = open_class(live, "Friday")
    ada, ben = join(live, group, "Ada"), join(live, group, "Ben")
    vote = ask(live, class_id=group["id"])["id"]
    for student in (ada, ben):
        assert cast(student, vote, 1)[0] == 200
    assert on_loop(live, rows()) == (1, 2)
    live.http.delete(f"/api/v1/classes/{group['id']}/members/{ada.id}")
    assert on_loop(live, rows()) == (1, 1)
    live.http.delete(f"/api/v1/classes/{group['id']}")
    assert on_loop(live, rows()) == (0, 0)

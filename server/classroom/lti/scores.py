"""Scores of lab sheets, sent to the platform when they change: never in the way of a board, again until it works."""

from __future__ import annotations

import asyncio
import logging
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any
from urllib.parse import urlsplit

from requests import RequestException

from server.classroom.audit import Audit
from server.classroom.lti.launch import SCORE, Launch
from server.classroom.lti.tool import Tool, Web
from server.classroom.sheet_work import SheetBrief, Work
from server.security.person import Person, new_secret
from server.store.base import now

log = logging.getLogger(__name__)

QUIET_S = 2.0
"""How long a score has to stay before it is sent."""
FIRST_WAIT_S, LONGEST_WAIT_S, MOST_TRIES = 5.0, 600.0, 12
"""Between tries the wait doubles; after the last, some two hours later, the next change or launch tries again."""

THREADS = 2
"""That wait for platforms, and for nothing else."""

KIND = "application/vnd.ims.lis.v1.score+json"
BY_SIGNATURE = {
    "grant_type": "client_credentials",
    "client_assertion_type": "urn:ietf:params:oauth:client-assertion-type:jwt-bearer",
}
Key = tuple[str, str]
"""A person and a sheet."""


@dataclass(frozen=True)
class ScoreTarget:
    """Where a score goes; the platform's id of the user is in memory alone."""

    launch: Launch
    person: Person


@dataclass(frozen=True)
class LtiScore:
    """A score, as it is sent."""

    given: float
    most: float
    done: bool
    comment: str
    at: str


class LtiScores:
    """Sends scores.

    Parameters
    ----------
    tool : Tool
        Signs for this server.
    audit : Audit
        The log for the teacher about failed deliveries.
    brief_of : callable
        Returns the progress of a student.
    quiet_s, first_wait_s : float
        How long a score has to stay, and how long to wait after the first try.
    """

    def __init__(
        self,
        tool: Tool,
        audit: Audit,
        brief_of: Callable[[Work], SheetBrief],
        quiet_s: float = QUIET_S,
        first_wait_s: float = FIRST_WAIT_S,
    ) -> None:
        self._tool, self._audit, self._brief_of = tool, audit, brief_of
        self._quiet_s, self._first_wait_s = quiet_s, first_wait_s
        self._targets: dict[Key, ScoreTarget] = {}
        self._wanted: dict[Key, LtiScore] = {}
        self._sent: dict[Key, LtiScore] = {}
        self._tasks: dict[Key, asyncio.Task[None]] = {}
        self._pool = ThreadPoolExecutor(THREADS, thread_name_prefix="combbench-scores")

    def aim(self, person: Person, launch: Launch, work: Work | None) -> None:
        """Send the score of a sheet to the address of a launch from now on, and the present score at once."""
        if not launch.line_item or not launch.sheet:
            return
        key = (person.id, launch.sheet)
        self._targets[key] = ScoreTarget(launch, person)
        self._sent.pop(key, None)
        if work is not None and work.progress.steps:
            self.changed(work)

    def changed(self, work: Work) -> None:
        """Note that a student's work has changed; it is sent when it is unchanged for a while."""
        key = (work.person_id, work.sheet_id)
        if key not in self._targets:
            return
        brief = self._brief_of(work)
        where = "all steps" if brief.done else f"step {brief.step} of {brief.steps}"
        at = now().isoformat(timespec="milliseconds")
        score = LtiScore(max(0.0, brief.earned), brief.points, brief.done, f"{brief.title}: {where}", at)
        before = self._wanted.get(key)
        if before is not None and _same(before, score) and (key in self._tasks or self._sent.get(key) == before):
            return
        self._wanted[key] = score
        if key not in self._tasks:
            self._tasks[key] = asyncio.get_running_loop().create_task(self._send(key))

    async def close(self) -> None:
        """Stop; unsent scores are sent at the next launch."""
        for task in list(self._tasks.values()):
            task.cancel()
        await asyncio.gather(*self._tasks.values(), return_exceptions=True)
        self._pool.shutdown(wait=False, cancel_futures=True)

    async def _send(self, key: Key) -> None:
        """Send the score of a sheet until the platform has it as it is."""
        tries, wait_s = 0, self._first_wait_s
        try:
            while self._sent.get(key) != self._wanted[key] and tries < MOST_TRIES:
                await asyncio.sleep(self._quiet_s)
                score, target = self._wanted[key], self._targets[key]
                try:
                    await asyncio.get_running_loop().run_in_executor(self._pool, self._post, target, score)
                except (RequestException, ValueError, KeyError, TypeError) as error:
                    tries += 1
                    self._note_failure(target, key[1], error, tries)
                    await asyncio.sleep(wait_s)
                    wait_s = min(2.0 * wait_s, LONGEST_WAIT_S)
                else:
                    if tries:
                        self._audit.add("lti", "grade", _line(target, key[1], "sent after all"), target.person.class_id)
                    self._sent[key] = score
                    tries, wait_s = 0, self._first_wait_s
        except Exception:
            log.exception("the score of a sheet could not be sent")
        finally:
            self._tasks.pop(key, None)

    def _note_failure(self, target: ScoreTarget, sheet: str, error: Exception, tries: int) -> None:
        """Tell the log every time, and the teacher at the first try and the last."""
        answer = error.response if isinstance(error, RequestException) else None
        status = f": the platform answered {answer.status_code}" if answer is not None else ""
        log.warning("the score of a sheet could not be sent (try %d): %s%s", tries, type(error).__name__, status)
        if tries in (1, MOST_TRIES):
            said = (
                "not sent"
                + (status or ": the platform does not answer")
                + ("; it is tried again" if tries == 1 else "; the next change or launch tries again")
            )
            self._audit.add("lti", "grade", _line(target, sheet, said), target.person.class_id)

    def _post(self, target: ScoreTarget, score: LtiScore) -> None:
        """Send a score; in a thread."""
        platform, now_s = target.launch.platform, int(time.time())
        body: dict[str, Any] = {
            "scoreGiven": score.given,
            "scoreMaximum": score.most,
            "timestamp": score.at,
            "activityProgress": "Completed" if score.done else "InProgress",
            "gradingProgress": "FullyGraded" if score.done else "Pending",
            "userId": target.launch.user,
            "comment": score.comment,
        }
        asks = {
            "iss": platform.client_id,
            "sub": platform.client_id,
            "aud": platform.auth_token_url,
            "iat": now_s - 5,
            "exp": now_s + 60,
            "jti": new_secret(),
        }
        given = {"client_assertion": self._tool.sign(asks), "scope": SCORE}  # the right to send scores, and no other
        with Web() as web:
            token = web.post(platform.auth_token_url, {**BY_SIGNATURE, **given})
            token.raise_for_status()
            headers = {"Authorization": f"Bearer {token.json()['access_token']}", "Content-Type": KIND}
            web.post(_scores_of(target.launch.line_item), json=body, headers=headers).raise_for_status()


def _scores_of(line_item: str) -> str:
    """Return where the scores of a column go: below its path, with its query."""
    parts = urlsplit(line_item)
    return parts._replace(path=f"{parts.path.rstrip('/')}/scores").geturl()


def _same(one: LtiScore, other: LtiScore) -> bool:
    """Whether the platform would show the same."""
    return (one.given, one.done, one.comment) == (other.given, other.done, other.comment)


def _line(target: ScoreTarget, sheet: str, what: str) -> str:
    return f"the score of {target.person.name} at {sheet} was {what}"

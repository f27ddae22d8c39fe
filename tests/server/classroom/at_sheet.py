"""A student works at a sheet by REST: drives the bench, answers from closed forms, and looks at the points."""

from __future__ import annotations

import math
from typing import Any

from scenarios.sheets.progress import Progress
from tests.server.classroom.group import Somebody, the_teacher
from tests.server.conftest import Live

API = "/api/v1"


class AtSheet:
    """A person at a sheet, on its bench, which runs by steps alone."""

    def __init__(self, live: Live, sheet: str, person: Somebody | None = None) -> None:
        self.live, self.sheet = live, sheet
        self.person = person or the_teacher(live)
        self.view: dict[str, Any] = self.ask("POST", f"/sheets/{sheet}/begin")
        self.bench = self.view["bench"]
        self.do(kind="pause")
        self.do(kind="reset")

    def ask(self, method: str, path: str, status: int = 200, **body: Any) -> Any:
        answer = self.person.ask(method, API + path, **({"json": body} if body else {}))
        assert answer.status_code == status, (method, path, body, answer.text)
        return answer.json() if answer.content else None

    def do(self, **command: Any) -> None:
        self.ask("POST", f"/benches/{self.bench}/commands", **command)

    def set(self, **values: Any) -> None:
        self.do(set={path.replace("__", "."): value for path, value in values.items()})

    def run(self, ms: float) -> None:
        """Run for so much device time."""
        left = round(ms / self.dt_ms)
        while left > 0:
            self.do(kind="step", ticks=min(left, 10_000))
            left -= 10_000

    @property
    def dt_ms(self) -> float:
        return float(self.about["dt_ms"])

    @property
    def about(self) -> dict[str, Any]:
        found: dict[str, Any] = self.ask("GET", f"/benches/{self.bench}")
        return found

    def look(self) -> dict[str, Any]:
        self.view = self.ask("GET", f"/sheets/{self.sheet}")
        return self.view

    def step(self, name: str) -> dict[str, Any]:
        """Return a step as it is now; also a finished step, or nothing while it is closed."""
        return next((s["step"] for s in self.look()["sections"] if s["step"] and s["step"]["id"] == name), {})

    def answer(self, name: str, text: str) -> dict[str, Any]:
        self.view = self.ask("POST", f"/sheets/{self.sheet}/steps/{name}/answer", answer=text)
        return self.step(name)

    def right(self, name: str, text: str) -> None:
        """Give an answer that earns all points of its step."""
        step = self.answer(name, text)
        assert step["earned"] in (step["points"], None), (name, text, step["answers"])

    def held(self, name: str, ms: float) -> dict[str, Any]:
        """Run until a step is done, at most for so much device time, and return it."""
        for _ in range(50):
            self.run(ms / 50)
            step = self.step(name)
            if step["earned"]:
                assert step["earned"] == step["points"]
                return step
        raise AssertionError(f"{name} is not done: {self.step(name)}")

    def measured(self, name: str, label: str) -> float:
        """Return the value that the server has measured at a step; no door tells it."""
        values = self.kept.steps[name].values
        return float(next(value for key, value in values.items() if key.startswith(label)) or 0.0)

    @property
    def kept(self) -> Progress:
        """The progress that the server keeps."""
        works = self.live.service.sheets.works(self.person.id)
        return next(work.progress for work in works if work.sheet_id == self.sheet)

    @property
    def device(self) -> dict[str, float]:
        """Mass, stiffness, damping and static gain of this bench."""
        document = self.about["parameters"]
        body = {"device": document["device"], "environment": document.get("environment", {})}
        found: dict[str, float] = self.live.http.post(f"{API}/devices/evaluate", json=body).json()["metrics"]
        return {name.removeprefix("device."): value for name, value in found.items()}


def response(m: float, k: float, beta: float, hz: float) -> complex:
    """Return the displacement of a mass on a spring per unit of force."""
    w = 2.0 * math.pi * hz
    return 1.0 / complex(k - m * w * w, beta * w)

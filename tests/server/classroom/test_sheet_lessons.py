"""Every sheet from start to end by REST: right values from closed forms earn all points."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import pytest

from core.errors import InputError
from scenarios import sheets
from scenarios.sheets.judge import judge
from scenarios.sheets.sheet import Prediction, SheetQuestion
from tests.server.classroom.at_sheet import AtSheet, response
from tests.server.classroom.offline import Offline
from tests.server.conftest import Live


def first_look(at: AtSheet) -> None:
    d, hz = at.device, 1500.0
    m, k, beta = d["mass_kg"], d["stiffness_n_m"], d["damping_ns_m"]
    volts_um = abs(d["static_gain_um_per_v"]) * k
    before, after = (10.0 * volts_um * abs(response(mass, k, beta, hz)) for mass in (m, 1.05 * m))
    at.held("running", 20.0)
    at.right("amplitude", f"{before * 1e3:.0f} nm")
    at.right("guess", "grows")
    at.do(fault="added_mass", severity=0.05)
    at.held("heavy", 40.0)
    at.right("growth", f"{100 * (after / before - 1):.2f} %")
    at.right("slow", "nothing")
    at.do(heal="all")
    at.held("healed", 40.0)


def resonance(at: AtSheet) -> None:
    d = at.device
    m, k, beta = d["mass_kg"], d["stiffness_n_m"], d["damping_ns_m"]
    f0, q = math.sqrt(k / m) / (2 * math.pi), math.sqrt(k * m) / beta
    at.set(reference__frequency_hz=200.0)
    at.held("slow", 60.0)
    at.right("gain", f"{d['static_gain_um_per_v']:.4f} um/V")
    at.right("peak_guess", "below")
    at.set(reference__frequency_hz=round(f0, 1))
    at.held("resonance", 60.0)
    # the amplitude that the server has measured equals the closed form, static gain times Q
    measured = at.measured("resonance", "Amplitude of the displacement")
    assert measured == pytest.approx(4.0 * abs(d["static_gain_um_per_v"]) * q, rel=0.02)
    at.right("f0", f"{f0 / 1e3:.4f} kHz")
    at.right("q", f"{q:.3f}")
    edges = [(1 - 1 / (2 * q * q)) + sign * math.sqrt(1 - 1 / (4 * q * q)) / q for sign in (-1.0, 1.0)]
    at.right("bandwidth", f"{f0 * (math.sqrt(edges[1]) - math.sqrt(edges[0])):.1f} Hz")
    at.set(reference__amplitude_v=0.0)
    at.held("quiet", 20.0)
    at.right("decay", f"{2e6 * m / beta:.0f} us")
    at.right("mass", "-2.41 %")


def pid_against_mrac(at: AtSheet) -> None:
    text = " ".join(s["text"] for s in at.look()["sections"])
    more = float(text.split("get stiffer by ")[1].split(" ")[0]) / 100.0
    d, hz = at.device, 1e3 / (2 * math.pi)
    m, k, beta = d["mass_kg"], d["stiffness_n_m"], d["damping_ns_m"]
    effort = abs(response(m, k, beta, hz) / response(m, k * (1 + more), beta, hz))
    at.right("left", f"{1 / effort:.4f}")
    at.do(fault="stiffness", severity=more)
    at.held("open", 100.0)
    at.right("better", "mrac")
    at.do(switch="pid")
    at.held("pid", 100.0)
    at.do(switch="mrac")
    at.held("mrac", 300.0)
    assert at.measured("mrac", "Amplitude of the voltage") == pytest.approx(10.0 * effort, rel=0.01)
    at.right("effort", f"{effort:.4f}")
    at.right("gains", "tone")


def variable_structure(at: AtSheet) -> None:
    at.held("near", 100.0)
    for amplitude in (0.7, 0.9, 1.0):
        at.set(reference__amplitude_um=amplitude)
        at.run(15.0)
    at.held("middle", 100.0)
    ratio = at.measured("middle", "Amplitude over") / at.measured("near", "Amplitude over")
    at.right("softer", f"{ratio:.4f}")
    text = " ".join(s["text"] for s in at.look()["sections"])
    far = float(text.split("shuttle is to go to ")[1].split("\u00a0")[0].split(" ")[0])
    at.right("guess", "feedback")
    at.do(switch="stvsc")
    at.run(10.0)
    at.set(reference__amplitude_um=far)
    at.held("beyond", 200.0)
    at.right("effort", f"{at.measured('beyond', 'Voltage over'):.4f}")
    at.do(switch="pid")
    at.held("pid", 200.0)
    at.set(reference__amplitude_um=1.0)
    at.run(15.0)
    at.do(switch="stvsc")
    at.run(10.0)
    at.set(controllers__stvsc__layer_um=0.0)
    at.held("chatter", 100.0)
    at.right("why", "sample")


def identification(at: AtSheet) -> None:
    at.right("guess", "two")
    text = " ".join(s["text"] for s in at.look()["sections"])
    spring, mass = (float(text.split(word)[1].split(" ")[0]) / 100 for word in ("Inject *Stiffness* ", "*Added mass* "))
    at.do(fault="stiffness", severity=spring)
    at.do(fault="added_mass", severity=mass)
    at.held("one", 200.0)
    assert at.measured("one", "Error of the worst") > 5.0
    at.right("residual", "fits")
    at.set(reference__kind="multi_sine")
    at.held("two", 400.0)
    assert at.measured("two", "Estimated mass") == pytest.approx(1 + mass, rel=0.01)
    d = at.device
    f0 = math.sqrt(d["stiffness_n_m"] * (1 + spring) / (d["mass_kg"] * (1 + mass))) / (2 * math.pi)
    at.right("moved", f"{f0:.1f} Hz")
    at.right("noise", "rich")


def kalman_and_noise(at: AtSheet) -> None:
    at.held("fair", 200.0)
    at.do(fault="added_mass", severity=0.05)
    at.held("found", 100.0)
    at.right("delay", f"{at.measured('found', 'Delay') * 0.01:.3f} ms")
    text = " ".join(s["text"] for s in at.look()["sections"])
    scale = float(text.split("assumed variance to ")[1].split(" ")[0])
    at.right("guess", f"{at.measured('fair', 'NIS') / scale:.3f}")
    at.do(heal="all")
    at.set(diagnosers__kalman__assumed_noise_scale=scale)
    at.held("under", 400.0)
    assert at.measured("under", "NIS") == pytest.approx(at.measured("fair", "NIS") / scale, rel=0.08)
    at.right("law", f"{10 ** (3 * (1 - scale)):.2f}")
    at.right("over", "slow")


def forgetting(at: AtSheet) -> None:
    asked = at.step("memory")["question"]
    factor = float(asked.split("factor ")[1].rstrip("?"))
    at.right("memory", f"{0.05 / (1 - factor):.4f} ms")
    at.run(20.0)
    at.do(fault="added_mass", severity=0.05)
    at.held("short", 100.0)
    at.right("guess", "longer")
    at.set(diagnosers__least_squares__forgetting=0.98)
    at.do(heal="all")
    at.held("healed", 100.0)
    at.do(fault="added_mass", severity=0.05)
    at.held("long", 100.0)
    ratio = at.measured("long", "Delay") / at.measured("short", "Delay")
    assert ratio > 1.5
    at.right("ratio", f"{ratio:.3f}")
    at.do(heal="all")
    at.set(diagnosers__least_squares__forgetting=0.86, sensors__ideal__noise_um=0.1)
    at.held("noisy", 300.0)
    at.set(diagnosers__least_squares__forgetting=0.98)
    at.held("calm", 300.0)
    assert at.measured("calm", "Share") < at.measured("noisy", "Share")
    at.right("which", "long")


def blind_diagnosis(at: AtSheet) -> None:
    f0 = at.device["f0_hz"]
    at.right("alias", f"{-5 * (2000 / f0) ** 2:.3f} %")
    at.right("honest", "seventy")
    for name in ("first", "second"):
        assert at.step(name)["earned"] == 0.0
        at.bench = at.ask("POST", f"/sheets/{at.sheet}/steps/{name}/hide", status=201)["bench"]
        path = f"/api/v1/benches/{at.bench}/blind"
        truth = at.live.service.benches.get(at.bench).view.rules.truth  # no door tells it
        assert at.live.http.post(f"{path}/answer", json={"said": truth, "confidence": 1.0}).json()["points"] == 100.0
        assert at.step(name)["earned"] == at.step(name)["points"]
    at.right("helps", "tone")


class Attentive(Offline):
    """A student who remembers all that conditions have shown, and compares it with each question."""

    shown: frozenset[str] = frozenset()

    def look(self) -> dict[str, Any]:
        view = super().look()
        steps = [section["step"] for section in view["sections"] if section["step"]]
        conditions = [condition for step in steps for condition in step["conditions"]]
        texts = [condition[field].removeprefix("at most ") for condition in conditions for field in ("now", "wanted")]
        self.shown = self.shown | {part for text in texts for part in (text, *text.split(" to "))}
        return view

    def right(self, name: str, text: str) -> None:
        self.look()
        step = self.lesson.step(name)
        assert isinstance(step, SheetQuestion | Prediction)
        told = [shown for shown in self.shown if self.earns(step, shown)]
        assert told == [], f"conditions have shown the answer to {name}"
        super().right(name, text)

    def earns(self, step: SheetQuestion | Prediction, text: str) -> bool:
        """Whether a text earns points as the right number or a known mistake, in the unit asked for if it has none."""
        asked = step.number and step.number.model_copy(update={"partly": None, "wrong_unit": 0.0, "right_sign": 0.0})
        strict = step.model_copy(update={"number": asked})
        for given in (text, f"{text} {asked.unit}" if asked else text):
            with suppress(InputError):
                if judge(strict, given, self.progress.facts).share > 0.0:
                    return True
        return False


LESSONS: dict[str, Callable[[AtSheet], None]] = {
    "first-look": first_look,
    "resonance-and-q": resonance,
    "pid-against-mrac": pid_against_mrac,
    "variable-structure": variable_structure,
    "identification": identification,
    "kalman-and-noise": kalman_and_noise,
    "forgetting": forgetting,
    "blind-diagnosis": blind_diagnosis,
}


def test_every_sheet_of_the_library_is_tried() -> None:
    assert set(LESSONS) == set(sheets.ids())
    assert len(LESSONS) >= 8


SLOW = {"variable-structure", "identification", "kalman-and-noise", "forgetting"}
"""Sheets that the long suite alone does by REST; the short one does them without a server."""


@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name in SLOW)) for name in LESSONS])
def test_a_sheet_from_start_to_end_earns_all_points(live: Live, name: str) -> None:
    at = AtSheet(live, name)
    LESSONS[name](at)
    view = at.look()
    assert view["done"]
    assert view["earned"] == view["points"] == sheets.get(name).points
    assert all(section["state"] == "done" and "{{" not in section["text"] for section in view["sections"])
    live.http.delete(f"/api/v1/sheets/{name}/progress")


@pytest.mark.parametrize("words", ["Ben", pytest.param("Ada Cleo Dora", marks=pytest.mark.long)])
@pytest.mark.parametrize("name", sorted(set(LESSONS) - {"blind-diagnosis"}))
def test_a_sheet_can_be_done_whatever_is_drawn_and_no_condition_shows_an_answer(name: str, words: str) -> None:
    for word in words.split():
        at = Attentive(name, word)
        LESSONS[name](at)
        assert at.shown
        assert at.look()["earned"] == at.view["points"], word


@pytest.mark.parametrize("name", LESSONS)
def test_whoever_leaves_out_every_run_comes_to_the_end(name: str) -> None:
    at = Offline(name, "Ada")
    left_out = 0
    while (step := at.progress.open_step(at.lesson)) is not None:
        shown = at.step(step.id)
        if shown["can_go_on"]:
            at.progress.go_on(at.lesson, step.id, 0)
            left_out += 1
        else:  # a prediction that can be judged is to be given
            at.answer(step.id, next(iter(shown["options"]), f"1 {shown['unit']}"))
        assert "{{" not in str(at.look())
    assert left_out and at.view["done"]
    assert all(s["step"]["solution"] != "" for s in at.view["sections"] if s["step"])

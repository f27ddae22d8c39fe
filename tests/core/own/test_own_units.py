"""User units: the same bits as the library's, all executions alike, and safe when they misbehave."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np
import pytest

from core import registry
from core.board.board import Board
from core.errors import InputError
from core.own.offered import OFFERED
from core.own.public import PUBLIC
from core.own.unit import unit
from scenarios.campaign.single import run_seeds
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build, run
from scenarios.schema import Scenario
from scenarios.seeds import parse_seeds
from tests.core.own.texts import FIT, PI, ROOT, odd

BASE = "ch3-mrac-mass-x10"
COPIED = (
    *("open_loop", "pid", "forced_drive", "open_loop_rate"),
    *("constant", "prbs", "sine", "square", "step"),
    *("added_mass", "damping", "drive_gain", "sensor_bias", "sensor_dropout", "sensor_hum", "sensor_noise"),
    *("sensor_quantisation", "shock", "stiffness", "vacuum_loss"),
    "ideal",
)
"""Units of the library whose file is a valid user unit without change."""


def with_unit(name: str, source: str, values: dict[str, Any] | None = None, base: str = BASE) -> Scenario:
    """Return a scenario of the library with a unit, and values written over."""
    document = {**copy.deepcopy(get(base).document), "units": {name: {"source": source}}, "expect": []}
    return with_values(Scenario.load(document), values or {})


def source_of(family: str, name: str) -> str:
    return (ROOT / "core" / family / f"{name}.py").read_text("utf-8")


FAMILIES = ("control", "reference", "faults", "sense", "diagnose", "supervise", "identify", "readout")
LIBRARY = [(family, name) for family in FAMILIES for name in registry.blocks(family)]


@pytest.mark.parametrize(("family", "name"), LIBRARY)
def test_files_of_the_library_that_are_units_as_they_are(family: str, name: str) -> None:
    try:
        one = unit(name, source_of(family, name))
    except InputError as error:
        assert name not in COPIED, error
        assert "line " in error.field
    else:
        assert name in COPIED and one.family == family


@pytest.mark.parametrize("name", ["pid", "open_loop"])
def test_a_controller_of_the_library_as_a_unit_gives_its_own_digest(name: str) -> None:
    theirs = run(with_values(get(BASE), {"controller.kind": name}))
    ours = run(with_unit(name, source_of("control", name), {"controller.kind": name}))
    assert ours.digest == theirs.digest


@pytest.mark.parametrize(
    ("family", "name", "values"),
    [
        ("reference", "sine", {}),
        ("reference", "prbs", {"reference": {"kind": "prbs", "amplitude_v": 5.0}}),
        ("sense", "ideal", {"sensors.ideal.noise_um": 0.05, "sensors.ideal.quantum_um": 0.01}),
        ("faults", "added_mass", {"events": [{"at_sample": 300, "fault": "added_mass", "severity": 0.05}]}),
        ("faults", "sensor_noise", {"events": [{"at_sample": 300, "fault": "sensor_noise", "severity": 0.05}]}),
    ],
)
def test_other_units_of_the_library_as_units_give_the_same_digest(
    family: str, name: str, values: dict[str, Any]
) -> None:
    theirs = with_values(get("first-look"), {"samples": 2000, "expect": [], **values})
    ours = Scenario.load({**theirs.document, "units": {name: {"source": source_of(family, name)}}})
    assert run(ours).digest == run(theirs).digest


def test_a_unit_is_the_same_compiled_and_as_plain_python() -> None:
    scenario = with_unit("pi", PI, {"controller.kind": "pi"})
    boards = [build(scenario), build(scenario, compiled=False)]
    for board in boards:
        board.advance(400)
    assert boards[0].digest() == boards[1].digest()


def test_a_unit_is_the_same_alone_and_abreast() -> None:
    scenario = with_unit("pi", PI, {"controller.kind": "pi", "controllers.pi.proportional_v_um": -0.5})
    alone = [run(scenario, seed).summary()["metrics"]["control.rms_error_um"] for seed in range(1, 10)]
    many = run_seeds(scenario, parse_seeds("1:9"))["metrics"]["control.rms_error_um"]
    assert many == pytest.approx(float(np.mean(alone)), rel=1e-13)


def test_a_unit_computes_its_law() -> None:
    """u = Kp e + Ki sum(e dt), over the signals it puts out."""
    scenario = with_unit(
        "pi", PI, {"controller.kind": "pi", "controllers.pi.proportional_v_um": -0.5, "duration_ms": 5.0}
    )
    result = run(scenario, taps=True)
    error, voltage = result.signal("pi.error"), result.signal("pi.voltage")
    dt_ms = scenario.spec.dt_ms
    first = voltage[0] + 0.5 * error[0]
    wanted = -0.5 * error + first + np.concatenate([[0.0], np.cumsum(-5.0 * error[1:] * dt_ms)])
    np.testing.assert_allclose(voltage, wanted, rtol=1e-9, atol=1e-9)


def test_a_unit_runs_in_shadow_beside_the_library_and_counts_for_no_digest_there() -> None:
    plain = run(Scenario.load({**get(BASE).document, "expect": []}))
    ours = run(with_unit("pi", PI), everything=True)
    assert ours.digest == plain.digest


def test_a_unit_that_puts_out_no_number_trips_the_board_when_it_drives() -> None:
    text = odd("step", "bad = (e - e) / (e - e)\nx.seen = bad").replace("x.voltage = p.gain * e", "x.voltage = bad")
    board = build(with_unit("odd", text))
    board.advance(100)
    assert board.trip is None, "in shadow it disturbs nobody"
    driving = build(with_unit("odd", text, {"controller.kind": "odd"}))
    driving.advance(100)
    assert driving.trip is not None and driving.trip.tick <= 1


def test_an_index_from_data_never_leaves_its_vector() -> None:
    """Outside it reads NaN and writes nothing."""
    text = odd(
        "step",
        "place = x.tick - 2.0\ns.line[int(place)] = 7.0\nx.seen = s.line[int(place)]\n"
        "total = 0.0\nfor i in range(12):\n    total += s.grid[i]\nx.three[0] = total",
    )
    board = build(with_unit("odd", text))
    seen = [(board.advance(1), board.value("odd.seen"), board.value("odd.three.a")) for _ in range(12)]
    wanted = [7.0 if 0 <= tick - 2 < 5 else np.nan for tick in range(12)]
    np.testing.assert_array_equal([one[1] for one in seen], wanted)
    assert all(one[2] == 0.0 for one in seen), "no other vector was written"


def test_a_unit_cannot_change_or_come_while_the_board_runs() -> None:
    board = build(with_unit("pi", PI))
    assert isinstance(board, Board)
    from core.board.commands import SetValues

    with pytest.raises(InputError) as raised:
        board.apply(SetValues(set={"units.pi.source": odd()}), "test")
    assert raised.value.code == "not_live"


@pytest.mark.parametrize(
    ("units", "field"),
    [
        ("pi", "units"),
        ({"pi": PI}, "units.pi"),
        ({"Pi!": {"source": PI}}, "units.'Pi!'"),
        ({"pi": {"source": PI, "family": "control"}}, "units.pi.family"),
        ({"pi": {"source": "x = (1,\n"}}, "units.pi.source.line 1, column 5"),
    ],
)
def test_a_wrong_table_of_units_is_refused_by_name(units: Any, field: str) -> None:
    with pytest.raises(InputError) as raised:
        Scenario.load({**get(BASE).document, "units": units})
    assert raised.value.field == field


def test_the_key_of_a_run_holds_the_text_of_its_units() -> None:
    from scenarios.key import content_hash

    one, other = with_unit("pi", PI), with_unit("pi", PI + "\n# the same law\n")
    assert content_hash(one.document) != content_hash(other.document)


def examples() -> list[str]:
    """Return the units of the document."""
    text = (ROOT / "docs" / "own-units.md").read_text("utf-8")
    return [part.partition("```")[0] for part in text.split("```python\n")[1:]]


def test_the_units_of_the_document_work() -> None:
    pi, judge, *_ = examples()
    assert unit("pi", pi).family == "control"
    steps = with_unit("leaky_squares", judge, {"diagnosers.mine.kind": "leaky_squares"}, "ch5-seven-step")
    assert run(steps).summary()["metrics"]["diagnosis.mine.correct_fraction"] > 0.8


def test_the_document_lists_what_is_offered_and_what_is_public() -> None:
    text = (ROOT / "docs" / "own-units.md").read_text("utf-8")
    for module, names in OFFERED.items():
        assert f"| `{module}` | {', '.join(f'`{name}`' for name in names)} |" in text
    for sources in PUBLIC.values():
        assert (", ".join(f"`{source}`" for source in sources) or "none") in text


def test_no_public_source_carries_the_truth() -> None:
    """In the inputs of controllers and diagnosers, a fault moves only the signals that it would move in a
    laboratory."""
    hidden = ("effects.", "plant.", "faults.", "environment.", "guard.", "score", "truth")
    known = {"plant.missing?"}  # a laboratory knows which samples it lost
    for family in {*PUBLIC} - {"sense", "faults"}:
        sources = {*PUBLIC[family]} - known
        assert not [source for source in sources if source.startswith(hidden) or "truth" in source]


def test_the_board_scores_an_identifier_and_it_never_sees_the_truth() -> None:
    """error = max |estimate/truth - 1|, with 5 % of mass added after 300 samples."""
    values = {"identifiers.mine.kind": "fit", "events": [{"at_sample": 300, "fault": "added_mass", "severity": 0.05}]}
    result = run(with_unit("fit", FIT, {**values, "samples": 400}, "first-look"), taps=True)
    estimate, truth = (result.signal(f"mine.{port}.mass") for port in ("estimate", "truth"))
    np.testing.assert_allclose(truth, np.where(np.arange(400) < 300, 1.0, 1.05), rtol=1e-12)
    np.testing.assert_allclose(result.signal("mine.error_pct"), 100.0 * np.abs(estimate / truth - 1.0), atol=1e-9)
    assert result.summary()["metrics"]["identify.mine.error_pct"] == pytest.approx(0.0, abs=1e-9)


def test_pack_may_call_functions_of_the_file_and_a_step_read_constants_of_it() -> None:
    top = "SHARES = (0.25, 3)\n'''What of the error is seen.'''\n@kernel\ndef twice(a):\n    return 2.0 * a"
    text = odd("step", "x.seen = SHARES[0] * twice(e) + SHARES[1]", top=top, pack="p.gain = twice(params.gain)")
    board = build(with_unit("odd", text.replace("SHARES[1]", "SHARES[1] * p.gain")))
    board.advance(50)
    error = board.value("model.displacement") - board.value("sensor.displacement")
    assert board.value("odd.seen") == 0.5 * error + 6.0
    for wrong in ("x.seen = SHARES[2]", "for i in range(2):\n    x.seen = SHARES[i]", "x.seen = SHARES"):
        with pytest.raises(InputError, match=r"tuple|no value"):
            unit("odd", odd("step", wrong, top=top))
    with pytest.raises(InputError, match="too deeply"):
        build(with_unit("odd", odd("pack", "p.gain = again(1.0)", top="def again(a):\n    return again(a)")))

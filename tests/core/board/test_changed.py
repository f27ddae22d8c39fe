"""A changed bench is the bench its document describes, and its wiring the one it would have from the start."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core import registry
from core.board.difference import change
from core.board.document import with_values
from core.board.parse import changed, parse
from core.board.spec import Spec
from core.board.wiring import wire
from core.errors import InputError
from tests.lab import QUIET, RICH, document

BENCH = document({"sensors.dual_beam.spot_um": 1.0}, RICH)
VALUES: dict[str, list[Any]] = {
    "reference.amplitude_v": [1.0, 2.5, True, "much", None],
    "reference.frequency_hz": [500.0, 1500, -1.0],
    "reference.kind": ["sine", "square", "constant", "tune"],
    "controller.kind": ["mrac", "pid", "open_loop", "nobody"],
    "controllers.mrac.adaptation_gain": [0.5, 2.0, 0.0],
    "controllers.pid.pole": [1.0, 2.0],
    "sensor.kind": ["ideal", "capacitive", "quadrature", "doppler"],
    "sensor.noise_um": [0.02, 0.0],
    "sensors.dual_beam.spot_um": [0.5, 3.9],
    "environment.temperature_k": [310.0, 20.0],
    "drive.limit_v": [20.0, 0.0],
    "drive.kind": ["held", "analogue"],
    "guard.rail_ms": [4.0],
    "plant.model": ["linear", "nonlinear", "planar"],
    "plant.gap_um": [1.9],
    "model.kind": ["copy", "damped"],
    "diagnosers.kalman.probability_floor": [1e-4, 0.2],
    "diagnosers.kalman.kind": ["imm", "reseed"],
    "sample_rate_khz": [50.0],
    "device.id": ["ch4"],
    "nothing.of_this": [1.0],
}
one_value = st.sampled_from([(path, value) for path, values in VALUES.items() for value in values])


def outcome(make: Any, *arguments: Any) -> Spec | tuple[str, str]:
    try:
        found: Spec = make(*arguments)
    except InputError as error:
        return error.field, error.message
    return found


@given(changes=st.lists(st.lists(one_value, min_size=1, max_size=3).map(dict), min_size=1, max_size=4))
def test_a_changed_bench_is_the_one_its_document_describes(changes):
    spec = parse(BENCH)
    for values in changes:
        now = outcome(changed, spec, values)
        anew = outcome(lambda *both: parse(with_values(*both)), spec.document, values)
        alike = outcome(lambda *both, like=spec: parse(with_values(*both), like), spec.document, values)
        if isinstance(now, tuple) or isinstance(anew, tuple) or isinstance(alike, tuple):
            assert now == anew == alike
            continue
        for part in fields(Spec):
            assert getattr(now, part.name) == getattr(anew, part.name) == getattr(alike, part.name), part.name
        for every in (1, 2):
            assert now.context(every) == anew.context(every) == alike.context(every)
        spec = now
    assert parse(BENCH) == parse(document({}, BENCH)), "the document that was given has changed"


@pytest.mark.parametrize(("value", "text"), [(True, "True"), (-0.0, "-0.0")])
def test_a_number_is_not_taken_from_a_bench_that_says_it_in_other_bits(value, text):
    path = "reference.amplitude_v"
    like = parse(with_values(QUIET, {path: 1.0 if value else 0.0}))
    found, anew = (outcome(parse, with_values(QUIET, {path: value}), *more) for more in ((like,), ()))
    assert repr(found) == repr(anew) and text in repr(found)


def test_another_device_leaves_out_the_controllers_and_sensors_that_do_not_suit_it():
    spec, values = parse(QUIET), {"device": {"id": "first-order-gain"}, "plant": {"model": "transfer_function"}}
    now, anew = changed(spec, values), parse(with_values(QUIET, values))
    assert list(now.controllers) == list(anew.controllers) != list(spec.controllers)
    assert list(now.sensors) == list(anew.sensors) != list(spec.sensors)
    back = changed(now, {key: spec.document[key] for key in values})
    assert list(back.controllers) == list(spec.controllers) and list(back.sensors) == list(spec.sensors)


LIVE = [(path, value) for path, value in [(p, v) for p, values in VALUES.items() for v in values] if "." in path]


@given(
    commands=st.lists(
        st.one_of(
            st.sampled_from(LIVE),
            st.tuples(st.sampled_from(["added_mass", "stiffness", "broken_truss"]), st.sampled_from([0.0, 0.05, 0.1])),
        ),
        min_size=1,
        max_size=6,
    )
)
def test_a_changed_wiring_is_the_one_it_would_have_from_the_start(commands):
    spec = parse(BENCH)
    wiring = wire(spec)
    for path, value in commands:
        if "." in path:
            new = outcome(changed, spec, {path: value})
            if isinstance(new, tuple) or new.frame != spec.frame:
                continue
        else:
            rest = {name: params for name, params in spec.faults.items() if name != path}
            fault = {path: registry.block("faults", path).Params(severity=value)} if value else {}
            new = spec.with_faults({**rest, **fault})
        if not change(wiring, spec, new):
            continue
        spec = new
        fresh = wire(spec)
        np.testing.assert_array_equal(wiring.p, fresh.p)
        np.testing.assert_array_equal(wiring.io, fresh.io)
        np.testing.assert_array_equal(wiring.table, fresh.table)
        assert wiring.instances == fresh.instances
        assert (wiring.unread, wiring.absent) == (fresh.unread, fresh.absent)
        engaged = [wiring.w[wiring.index[f"{name}.engaged"]] for name in spec.controllers]
        assert engaged == [float(name == spec.active) for name in spec.controllers]


def test_a_refused_change_leaves_the_wiring_alone(monkeypatch):
    spec = parse(BENCH)
    wiring = wire(spec)
    before = wiring.p.copy(), wiring.instances
    new = changed(spec, {"reference.amplitude_v": 3.0, "controllers.mrac.adaptation_gain": 2.0})
    block = registry.block("control", "mrac")

    def refuse(params: Any, context: Any) -> Any:
        raise InputError("is refused", "adaptation_gain")

    monkeypatch.setattr(block, "pack", refuse)
    with pytest.raises(InputError, match="is refused"):
        change(wiring, spec, new)
    np.testing.assert_array_equal(wiring.p, before[0])
    assert wiring.instances is before[1]

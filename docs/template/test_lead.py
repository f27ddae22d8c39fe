"""The compensator of an installed package: found by its name, and its law by scipy."""

import numpy as np
from scipy.signal import cont2discrete, lfilter

from core.registry import blocks
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import run


def test_every_bench_has_it() -> None:
    assert blocks("control")["lead"].family == "control"


def test_it_is_the_lead_that_its_equation_says() -> None:
    values = {"controller.kind": "lead", "controllers.lead.gain_v_um": -2.0, "duration_ms": 5.0, "expect": []}
    scenario = with_values(get("first-look"), values)
    result = run(scenario, taps=True)
    time, lag = 0.1, 0.2 * 0.1
    (numerator,), denominator, _ = cont2discrete(([time, 1.0], [lag, 1.0]), scenario.spec.dt_ms)
    wanted = -2.0 * lfilter(numerator, denominator, result.signal("lead.error"))
    correction = result.signal("lead.voltage") - result.signal("reference.voltage")
    np.testing.assert_allclose(correction, wanted, atol=1e-9)

"""Every fault is visible on its part, faults without a drawing too."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

from core import registry
from core.device.geometry import Geometry
from core.faults.fault import Fault, FaultParams
from core.ports import BlockPorts, output
from server.view3d.marks import words
from server.view3d.pose import Active
from server.view3d.resonator.layout import Layout
from server.view3d.resonator.marks import ResonatorMarks

LAYOUT = Layout(Geometry())


@cache
def faults() -> dict[str, Any]:
    return dict(registry.blocks("faults"))


def active(name: str, severity: float = 0.0, **more: Any) -> Active:
    block = faults()[name]
    severity = severity or block.suggested
    return Active(block, block.Params(severity=severity, **more), severity)


def shown(name: str, severity: float = 0.0, **more: Any) -> ResonatorMarks:
    return ResonatorMarks([active(name, severity, **more)], LAYOUT)


def test_every_fault_says_what_it_is_within_the_picture() -> None:
    for name, block in faults().items():
        found = shown(name)
        ((x, y, _), lines), *rest = found.labels.items()
        assert not rest and lines[0].startswith(block.title), name
        assert abs(x) <= LAYOUT.half_length_um and abs(y) <= LAYOUT.half_width_um, name
        for mesh in found.solids.values():
            reach = np.abs(mesh.vertices[:, :2]).max(0)
            assert (reach <= (LAYOUT.half_length_um, LAYOUT.half_width_um)).all(), name


def test_a_fault_nobody_has_drawn_is_a_label_at_its_part() -> None:
    for part in ("plate", "beams", "sensor", "what no part is called"):

        class Unheard(Fault):
            title, shows, name = "Unheard of", part, "unheard_of"

            class Ports(BlockPorts):
                severity: float = output("nm", "how bad")

        found = ResonatorMarks([Active(Unheard, FaultParams(severity=3.0), 3.0)], LAYOUT)
        assert list(found.labels.values()) == [["Unheard of 3\u00a0nm"]]
        assert not found.solids and not any(found.tints.values())


def test_severities_have_their_unit_as_people_write_it() -> None:
    assert words(active("sensor_bias", 0.5)) == "Sensor bias 500\u00a0nm"
    assert words(active("shock", 20.0)) == "Shock 20\u00a0g"
    assert words(active("added_mass", 0.05)) == "Added mass"


def test_the_label_of_a_shock_ends_within_a_wide_picture() -> None:
    """There the y axis goes across. It may be 320 px wide; a letter is 7 px wide."""
    for severity, axis in ((-20.0, "x"), (5000.0, "y")):
        (((_, y, _), (text,)),) = shown("shock", severity, axis=axis).labels.items()
        beside_px = (1.0 - abs(y) / LAYOUT.half_width_um) * 320 / 2
        assert beside_px >= 7 * len(text) / 2, text


def test_faults_at_one_place_share_a_label() -> None:
    found = ResonatorMarks([active("stiffness"), active("ageing")], LAYOUT)
    assert [len(lines) for lines in found.labels.values()] == [2]
    assert words(active("ageing", 4.0)) == "Ageing 4\u00a0weeks"


def test_an_adhesion_is_a_dot_where_it_holds() -> None:
    """Beams begin 37.5 um from the axis, are 350 um long and are at 15 and 45 um."""
    for beam, position, x, y in (("inner", 0.75, 15.0, 300.0), ("outer", 0.5, 45.0, 212.5)):
        found = shown("point_adhesion", 1.0, beam=beam, position=position)
        ((name, dot),) = found.solids.items()
        middle = (dot.vertices.max(0) + dot.vertices.min(0)) / 2
        np.testing.assert_allclose(middle[:2], (x, y), atol=1e-6)
        assert not name.startswith("shuttle/")
        assert found.damage is not None and found.damage.adhesion == (beam, position) and found.share == 1.0


def test_a_mass_rides_on_the_plate_and_grows_with_its_severity() -> None:
    heights = []
    for severity in (0.05, 0.15):
        ((name, block),) = shown("added_mass", severity).solids.items()
        assert name.startswith("shuttle/")
        assert block.vertices[:, 2].min() == pytest.approx(LAYOUT.top_um)
        heights.append(np.ptp(block.vertices[:, 2]))
    assert heights[1] == pytest.approx(3 * heights[0])


def test_debris_lies_in_its_comb() -> None:
    for comb, sign in (("right", 1.0), ("left", -1.0)):
        (chunk,) = shown("debris", comb=comb, place_um=-100.0).solids.values()
        x, y, _ = chunk.vertices.mean(0)
        assert LAYOUT.stator_um < sign * x < LAYOUT.tip_um and y == pytest.approx(-100.0)


def test_beams_of_one_side_are_tinted_alone() -> None:
    plus, minus = (shown("stiffness_one_side", 0.2).tints[f"beams/{side}"] for side in ("plus", "minus"))
    assert plus > 0.0 and minus == 0.0
    plus, minus = (shown("stiffness", 0.2).tints[f"beams/{side}"] for side in ("plus", "minus"))
    assert plus == minus > 0.0


def test_a_broken_truss_lies_apart_once_it_is_through() -> None:
    end, whole = (shown("broken_truss", 1.0, extent=extent) for extent in ("end", "whole"))
    sizes = [np.ptp(found.solids["broken-truss"].vertices, axis=0)[0] for found in (end, whole)]
    assert 2.5 < sizes[1] / sizes[0] < 3.0
    assert end.damage is not None and end.damage.lost_ends == (2,)
    cracked = ResonatorMarks([Active(faults()["broken_truss"], active("broken_truss").params, 0.4)], LAYOUT)
    assert cracked.share == pytest.approx(0.4)


def test_gas_and_drive_take_the_colour_of_attention() -> None:
    damping, vacuum_loss = (shown(name).tints["film"] for name in ("damping", "vacuum_loss"))
    assert vacuum_loss > damping > 0.0
    assert shown("drive_gain").tints["bases"] > 0.0


def test_a_shock_points_where_it_pushes() -> None:
    for severity, axis, k in ((20.0, "x", 0), (-20.0, "x", 0), (20.0, "y", 1)):
        at = shown("shock", severity, axis=axis).solids["shock"].vertices
        tip = at[np.ptp(at, axis=0).argmax() == k and 3]
        assert np.ptp(at[:, k]) == pytest.approx(70.0)
        assert np.sign(tip[k] - at[:, k].mean()) == np.sign(severity)

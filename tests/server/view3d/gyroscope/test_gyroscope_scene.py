"""Gyroscopes on a live bench: parts follow the signals with the factors that the caption says."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from server.bench.description import period_of
from server.view3d.colours import SILICON
from server.view3d.gyroscope import gyroscope
from server.view3d.gyroscope.gyroscope import ABOVE_UM, FORCE_UM
from server.view3d.gyroscope.parts import APART_UM, TOP_UM
from server.view3d.part import UM_PER_UNIT
from server.view3d.viewers import build_scene, device_of

SINGLE: dict[str, Any] = {
    "schema": 1,
    "id": "one-gyroscope",
    "title": "One gyroscope",
    "sample_rate_khz": 100,
    "seed": 1,
    "device": {"id": "gyro-c"},
    "plant": {"initial_x_um": 5.0},
    "rate": {"kind": "constant", "deg_per_s": 100.0},
    "controller": {"kind": "open_loop_rate"},
}
PAIR: dict[str, Any] = {
    **SINGLE,
    "id": "two-gyroscopes",
    "device": {"id": "gyro-4-5"},
    "plant": {"model": "gyroscope_pair"},
    "rate": {"kind": "constant", "deg_per_s": -50.0},
    "slots": {"drive": "drive_tracking"},
    "controller": {"kind": "sense_axis_sync"},
}


def factors(caption: str) -> tuple[float, float]:
    """Read the factors from a caption."""
    found = re.search(r"x × (\S+), y × (\S+),", caption.replace("\u202f", ""))
    assert found is not None, caption
    return float(found[1]), float(found[2])


@contextmanager
def drawn(live: Any, scenario: dict[str, Any], ticks: int) -> Iterator[tuple[Any, dict[str, Any], Any, Any]]:
    """Return bench, session, scene and device of a bench after some ticks."""
    bench = live.bench(scenario, paused=True)
    live.command(bench["id"], "step", ticks=ticks)
    session = live.service.benches.get(bench["id"])
    device, scene = build_scene(session)
    try:
        yield bench, session, scene, device
    finally:
        scene.close()


def middle(handle: Any) -> Any:
    """Return the middle of a mesh, um."""
    return (handle.vertices.max(0) + handle.vertices.min(0)) / 2 * UM_PER_UNIT


def test_the_mass_is_where_the_signals_say_by_the_factors_of_the_caption(live: Any) -> None:
    with drawn(live, SINGLE, 5000) as (bench, session, scene, device):
        for ticks in (1, 7, 11):
            live.command(bench["id"], "step", ticks=ticks)
            pose = device.pose()
            scene.show(pose)
            x, y = (session.board.value(f"plant.{axis}") for axis in "xy")
            fx, fy = factors(pose.caption)
            assert fx == 5.0 < fy
            assert pose.places == (pytest.approx((x * fx, y * fy), rel=1e-5),)
            plate, dot = scene.nodes["/first/plate"], scene.nodes["/first/dot"]
            np.testing.assert_allclose(middle(plate)[:2], (x * fx, y * fy), atol=1e-3)
            np.testing.assert_allclose(middle(dot), (x * fx, y * fy, TOP_UM + ABOVE_UM), atol=1e-3)
            orbit = scene.nodes["/first/orbit"].points
            np.testing.assert_allclose(orbit[-1, 1] * UM_PER_UNIT, (x * fx, y * fy, TOP_UM + ABOVE_UM), atol=1e-3)
            assert 0.9 * 5.0 * fx < np.abs(orbit[..., 0]).max() * UM_PER_UNIT < 1.05 * 5.0 * fx
        assert period_of(session) == pytest.approx(1e5 / 3925.29, rel=1e-3)
        assert (scene.nodes["/rate"].text, pose.turn) == ("rate +100\u00a0deg/s", 0.5)
        assert not scene.nodes["/force"].visible and "not to scale" in scene.nodes["/caption"].text


def test_a_fast_motion_is_strobed_evenly(live: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr(gyroscope, "time", SimpleNamespace(monotonic=lambda: now[0]))
    bench = live.bench(SINGLE, time_scale=1.0)
    session = live.service.benches.get(bench["id"])
    device, poses = device_of(session), []
    live.advance(seconds=0.5)
    for _ in range(40):
        live.advance(seconds=1.25 / 40)
        now[0] += 1.25 / 40
        pose = device.pose()
        assert pose.caption.endswith("strobe")
        poses.append(pose.places[0][0])
    # one period in 1.25 s: both ends of the swing, and no jumps between neighbours
    reach = max(np.abs(poses))
    assert max(poses) > 0.9 * reach and min(poses) < -0.9 * reach
    assert np.sort(np.abs(np.diff(poses)))[36] < 0.6 * reach


def test_two_stand_side_by_side_and_the_force_that_follows_is_an_arrow(live: Any) -> None:
    with drawn(live, PAIR, 9000) as (bench, session, scene, device):
        seen = set()
        arrow, words = scene.nodes["/force"], scene.nodes["/force-words"]
        for _ in range(6):
            live.command(bench["id"], "step", ticks=5)
            pose = device.pose()
            scene.show(pose)
            fx, fy = factors(pose.caption)
            signals = [session.board.value(f"plant.{axis}") for axis in ("x", "y", "partner_x", "partner_y")]
            np.testing.assert_allclose(np.ravel(pose.places), np.multiply(signals, (fx, fy, fx, fy)), rtol=1e-5)
            force = session.board.value("drive.y.force")
            assert np.sign(pose.force) == np.sign(force) and abs(pose.force) <= 1.0
            shaft = arrow.vertices[:, 1] * UM_PER_UNIT
            assert np.ptp(shaft) == pytest.approx(FORCE_UM * abs(pose.force), rel=1e-4)
            assert shaft[3] == pytest.approx(FORCE_UM * pose.force, rel=1e-4)
            seen.add(np.sign(force))
        assert seen == {1.0, -1.0} and arrow.visible and "µN" in words.text
        bodies = [scene.nodes[f"/{name}"].position * UM_PER_UNIT for name in ("first", "partner")]
        np.testing.assert_allclose(bodies, [(-APART_UM, 0.0, 0.0), (APART_UM, 0.0, 0.0)])
        assert pose.turn == -0.5 and scene.nodes["/rate"].text.startswith("rate \u221250")
        live.command(bench["id"], "switch", controller="open_loop_rate")
        live.command(bench["id"], "step", ticks=5)
        scene.show(device.pose())
        assert device.pose().force is None and not arrow.visible and not words.visible


def test_a_frame_is_a_handful_of_messages_and_none_when_nothing_moves(live: Any) -> None:
    for scenario, bodies, most in ((SINGLE, 1, 12), (PAIR, 2, 24)):
        with drawn(live, scenario, 9000) as (bench, _, scene, device):
            scene.show(device.pose())
            sent: list[Any] = []
            server = scene._server._websock_server
            queue = server.queue_message
            server.queue_message = lambda message, queue=queue, sent=sent: (sent.append(message), queue(message))
            scene.show(device.pose())
            assert not sent
            for _ in range(5):
                live.command(bench["id"], "step", ticks=7)
                sent.clear()
                scene.show(device.pose())
                assert 5 <= len(sent) <= most
                values = sum(np.size(value) for message in sent for value in vars(message).get("updates", {}).values())
                assert values < 4000 * bodies


def test_faults_reach_the_parts_of_the_first(live: Any) -> None:
    with drawn(live, PAIR, 100) as (bench, _, scene, device):
        first, partner = (
            {part: scene.nodes[f"/{name}/{part}"] for part in ("gas", "flexures-x", "flexures-y")}
            for name in ("first", "partner")
        )
        scene.show(device.pose())
        assert not scene.added and not first["gas"].visible
        for fault in ("added_mass", "stiffness", "damping", "sensor_bias"):
            live.command(bench["id"], "inject", fault=fault, severity=0.2)
        live.command(bench["id"], "step", ticks=2)
        scene.show(device.pose())
        assert {node.name for node in scene.added.values()} >= {"/first/mass/added-mass", "/labels/3"}
        assert first["gas"].visible and not partner["gas"].visible
        for beams in ("flexures-x", "flexures-y"):
            assert tuple(first[beams].color) != SILICON == tuple(partner[beams].color)
        live.command(bench["id"], "heal", faults="all")
        live.command(bench["id"], "step", ticks=2)
        scene.show(device.pose())
        assert not scene.added and not first["gas"].visible
        assert tuple(first["flexures-x"].color) == SILICON


def test_the_page_has_the_cameras_of_a_gyroscope(live: Any) -> None:
    pages = [live.http.get(live.bench(scenario, paused=True)["view3d"]).text for scenario in (SINGLE, PAIR)]
    boxes = [re.search(r'"whole": \{"box": \[\[(\S+), (\S+)\]', page) for page in pages]
    widths = [float(box[2]) - float(box[1]) for box in boxes if box is not None]
    assert widths[1] - widths[0] == pytest.approx(2 * APART_UM / UM_PER_UNIT)

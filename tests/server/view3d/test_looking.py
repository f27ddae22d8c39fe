"""A page that shows another moment: the pose of that tick from the history, and no other picture moves."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np
import pytest
import zstandard
from websockets.exceptions import ConnectionClosed

from server.view3d.gyroscope.gyroscope import GyroscopeModel
from server.view3d.part import UM_PER_UNIT
from server.view3d.resonator.resonator import ResonatorModel
from server.view3d.viewers import device_of
from tests.server.classroom.group import watcher
from tests.server.view3d.test_view3d import join


def look(page: Any, tick: int | None) -> None:
    page.send(msgspec.msgpack.encode({"type": "look", "tick": tick}))


def stepped(live: Any, *commands: tuple[int, dict[str, Any]], ticks: int, **bench: Any) -> Any:
    """Return a paused session, with commands at some ticks."""
    made = live.bench(paused=True, **bench)["id"]
    session = live.service.benches.get(made)
    for tick, command in [*commands, (ticks, {})]:
        while (left := tick - session.board.tick) > 0:
            assert live.command(made, "step", ticks=min(left, 1000)).status_code == 200
        if command:
            answer = live.command(made, **command)
            assert answer.status_code == 200, answer.text
    return session


def sample(session: Any, name: str, tick: int) -> float:
    return float(session.history.read(session.indices([name]), tick, tick + 1)[0, 0])


def test_a_pose_is_that_of_the_tick(live: Any) -> None:
    session = stepped(
        live,
        (300, {"fault": "added_mass", "severity": 0.2}),
        (500, {"heal": ["added_mass"]}),
        (700, {"fault": "added_mass", "severity": 0.4}),
        ticks=900,
    )
    for tick, severity in ((250, None), (400, 0.2), (600, None), (800, 0.4)):
        # a device that is drawn from now on: the log gives the parameters
        device = device_of(session)
        assert isinstance(device, ResonatorModel)
        pose = device.pose(tick)
        factor = device._factor
        assert pose.displacement_um == pytest.approx(factor * sample(session, "plant.displacement", tick), rel=1e-6)
        assert pose.reference_um == pytest.approx(factor * sample(session, "model.displacement", tick), rel=1e-6)
        winner = int(sample(session, "kalman.winner", tick))
        name = session.board.spec.diagnosers["kalman"].params.hypotheses[winner].name
        estimate = sample(session, "sensor.displacement", tick) - sample(session, f"kalman.residual.{name}", tick)
        assert pose.estimate_um == pytest.approx(factor * estimate, rel=1e-6)
        assert [fault.params.severity for fault in pose.faults] == ([] if severity is None else [severity])
        assert pose.when == f"at {tick * session.dt_ms:.3f}\u00a0ms"
    assert device.pose(session.history.end_tick) == device.pose(None) == device.pose(-1)
    assert device.pose().when == ""


def test_a_pose_has_the_light_of_then(live: Any) -> None:
    ideal = {"set": {"sensor.kind": "ideal"}}
    alone = {"sensors.quadrature_kalman.always": False}
    session = stepped(live, (300, ideal), scenario="ch2-dual-beam", set=alone, ticks=500)

    def light(tick: int | None) -> list[bool]:
        device = device_of(session)
        assert isinstance(device, ResonatorModel)
        return [beam.is_through for beam in device.pose(tick).lasers]

    assert light(250) == [True, True]
    assert light(450) == light(None) == []


def test_a_gyroscope_is_shown_as_it_was(live: Any) -> None:
    session = stepped(live, scenario="gyro-adaptive", ticks=3000)
    device = device_of(session)
    assert isinstance(device, GyroscopeModel)
    for tick in (1200, 2345):
        pose = device.pose(tick)
        x, y = (sample(session, f"plant.{axis}", tick) for axis in session.board.spec.axes[:2])
        np.testing.assert_allclose(pose.places[0], np.array(device._factors) * (x, y), rtol=1e-6)
        assert pose.when.startswith("at ") and "strobe" not in pose.caption
    assert device.pose(10**9).when == ""


def moments(page: Any, enough: Callable[[list[str]], bool], seen: Callable[[Any], bool] = lambda _: False) -> list[str]:
    """Take messages of a scene until they describe its moment completely, or a message is seen."""
    said: list[str] = []
    while not enough(said):
        data = page.recv(timeout=60)
        packed = zstandard.ZstdDecompressor().decompress(data[16 : 16 + int.from_bytes(data[8:16], "little")])
        for message in msgspec.msgpack.decode(packed)["messages"]:
            told = message.get("props") or message.get("updates") or {}
            if message.get("name") == "/when" and "text" in told:
                said.append(told["text"].replace("\u00a0", " "))
            if seen(message):
                return said
    return said


def until_moved(live: Any, session: Any, page: Any) -> list[str]:
    """Move the shuttle by a step of the bench; return what came of the moment until that was seen."""
    assert live.command(session.id, "step", ticks=7).status_code == 200
    return moments(page, lambda _: False, lambda message: message.get("name") == "/shuttle" and "position" in message)


def at_rest(live: Any, scene: Any) -> Any:
    """Return the pose of a bench that is paused: the one before may be of the strobe, which shows a bench that runs."""
    shown: list[Any] = []
    show = scene.show
    scene.show = lambda pose: (shown.append(pose), show(pose))
    live.wait(lambda: len(shown) > 1 and shown[-1] == shown[-2])
    del scene.show
    return scene._shown


def test_only_the_page_that_looks_is_moved_and_it_comes_back(live: Any) -> None:
    session = stepped(live, ticks=900)
    show = live.service.viewers.show_of(session)
    assert session.dt_ms == 0.02
    with join(live, {"id": session.id}) as page, join(live, {"id": session.id}) as other:
        assert moments(page, bool) == moments(other, bool) == [""]
        assert until_moved(live, session, page) == []
        shared = at_rest(live, show._scenes[None][0])
        look(page, 250)
        moments(page, lambda said: said[-1:] == ["at 5.000 ms"])
        (own,) = (scene for looked, (scene, _) in show._scenes.items() if looked is not None and looked.tick == 250)
        assert own.nodes["/shuttle"].position[0] == pytest.approx(own._shown.displacement_um / UM_PER_UNIT, rel=1e-5)
        assert own._shown.displacement_um != shared.displacement_um
        assert show._scenes[None][0]._shown == shared and shared.when == ""
        assert until_moved(live, session, other) == []
        shared = at_rest(live, show._scenes[None][0])
        look(page, None)
        assert moments(page, bool) == [""]
        assert own._shown == shared
        assert show.watchers == 2 and len(show._scenes) == 2
    live.wait(lambda: not show._scenes)  # no scene stays open without a page


def test_a_tick_that_the_history_has_not_leaves_the_page_with_now(live: Any) -> None:
    session = stepped(live, ticks=300)
    show = live.service.viewers.show_of(session)
    with join(live, {"id": session.id}) as page:
        moments(page, bool)
        look(page, 10**12)
        assert set(until_moved(live, session, page)) <= {""}
        for said in ({"type": "look", "tick": "x"}, {"type": "look"}, {"type": "look", "tick": 1, "more": 2}):
            page.send(msgspec.msgpack.encode(said))
        page.send(b"\x81" * 40)
        look(page, 100)
        moments(page, lambda said: said[-1:] == ["at 2.000 ms"])
        assert len(show._scenes) == 2
        live.http.delete(f"/api/v1/benches/{session.id}")
        with pytest.raises(ConnectionClosed):
            moments(page, lambda _: False)
    assert not show._scenes


def test_watchers_look_too_and_a_fault_that_is_hidden_ends_it(live: Any) -> None:
    session = stepped(live, ticks=300)
    guest = watcher(live, session.id)
    with join(live, {"id": session.id}, additional_headers=guest.headers) as page:
        moments(page, bool)
        look(page, 100)
        moments(page, lambda said: said[-1:] == ["at 2.000 ms"])
        # a value hidden from now on closes the past scene of a page, too
        assert live.http.post(f"/api/v1/benches/{session.id}/blind", json={"seed": 1}).status_code == 201
        with pytest.raises(ConnectionClosed):
            moments(page, lambda _: False)

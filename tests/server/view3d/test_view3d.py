"""The 3D view through our port: behind the gate, alive while watched, gone after."""

from __future__ import annotations

import os
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import msgspec
import numpy as np
import psutil
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from server.view3d.viewers import build_scene, device_of

VISER = "viser-v1.1.1"
MOST_MESSAGES, MOST_VALUES = 40, 40_000
"""Of a frame: the parts of a scene that move, and the numbers that place them."""


def join(live: Any, bench: dict[str, Any], **options: Any) -> Any:
    url = live.address.replace("http", "ws") + f"/benches/{bench['id']}/3d"
    headers = {"Authorization": live.http.headers["authorization"]}
    given: dict[str, Any] = {
        "additional_headers": headers,
        "subprotocols": [VISER],
        "proxy": None,
        "max_size": None,
        "compression": None,
        "close_timeout": 0.5,
    }
    return connect(url, **{**given, **options})


def arrive(socket_: Any, messages: int, live: Any = None) -> None:
    """Take so many messages; a server lets time pass for each."""
    for _ in range(messages):
        if live is not None:
            live.advance(seconds=0.05)
        socket_.recv(timeout=60)


@contextmanager
def drawn(live: Any, bench: dict[str, Any]) -> Iterator[tuple[Any, Callable[[], Any]]]:
    """Return a scene of a bench of its own, and what shows the bench in it."""
    session = live.service.benches.get(bench["id"])
    device, scene = build_scene(session)
    try:
        yield scene, lambda: scene.show(device.pose())
    finally:
        scene.close()


def listened(scene: Any) -> list[Any]:
    """Return the messages that a scene sends from now on."""
    sent: list[Any] = []
    server = scene._server._websock_server
    queue = server.queue_message
    server.queue_message = lambda message: (sent.append(message), queue(message))
    return sent


def test_the_page_is_visers_with_our_lines(live: Any) -> None:
    bench = live.bench()
    assert bench["view3d"] == f"/benches/{bench['id']}/3d/"
    page = live.http.get(bench["view3d"])
    assert page.status_code == 200
    assert "document.hasFocus = () => false" in page.text
    assert '"__DEVICE__"' not in page.text and '"whole": {"box"' in page.text
    assert "unsafe-eval" in page.headers["content-security-policy"]
    assert live.http.get("/benches/none/3d/").status_code == 404


def test_the_scene_moves_while_somebody_watches(live: Any) -> None:
    bench = live.bench(time_scale=0.002)
    show = live.service.viewers.show_of(live.service.benches.get(bench["id"]))
    with join(live, bench) as page:
        assert page.subprotocol == VISER
        arrive(page, 10, live)
        path = show._scenes[None][0].path
        with join(live, bench) as second:
            arrive(second, 5, live)
            assert show.watchers == 2 and show._scenes[None][0].path == path
    live.wait(lambda: not show._scenes and not path.parent.exists())  # the scene is open without a page


def test_a_paused_bench_sends_nothing(live: Any) -> None:
    bench = live.bench(paused=True)
    live.command(bench["id"], "step", ticks=100)
    with drawn(live, bench) as (scene, show):
        show()
        sent = listened(scene)
        show()
        assert not sent
        live.command(bench["id"], "step", ticks=10)
        show()
        assert sent


def listening() -> set[int]:
    """The TCP ports this process listens on."""
    found = psutil.Process().net_connections("tcp")
    return {connection.laddr.port for connection in found if connection.status == psutil.CONN_LISTEN}


def test_the_scene_is_on_no_port_and_its_socket_is_for_this_user_alone(live: Any) -> None:
    bench, before = live.bench(), listening()
    with join(live, bench) as page:
        arrive(page, 1)
        assert listening() <= before
        show = live.service.viewers.show_of(live.service.benches.get(bench["id"]))
        path = show._scenes[None][0].path
        assert path.is_socket()
        folder = path.parent.stat()
        assert folder.st_mode & 0o777 == 0o700 and folder.st_uid == os.getuid()


def test_a_temporary_folder_without_room_for_a_socket_is_told_in_one_line(
    live: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    deep = tmp_path / ("x" * 100)  # a socket's name has at most 107 bytes
    deep.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(deep))
    bench = live.bench()
    with join(live, bench) as page, pytest.raises(ConnectionClosed) as caught:
        page.recv(timeout=10)
    assert caught.value.rcvd is not None and caught.value.rcvd.code == 1012
    assert [record.exc_info for record in caplog.records] == [None] and "AF_UNIX path too long" in caplog.text
    assert not list(deep.iterdir())
    monkeypatch.undo()
    with join(live, bench) as page:
        arrive(page, 1)


def test_what_a_page_says_does_not_reach_the_scene(live: Any, caplog: pytest.LogCaptureFixture) -> None:
    """viser would open a public tunnel for any client, and breaks at unknown messages."""
    bench = live.bench(time_scale=0.002)
    with join(live, bench) as page:
        for said in (b"", b"\xff" * 300, "text", msgspec.msgpack.encode({"type": "ShareUrlRequest"})):
            page.send(said)
            arrive(page, 3, live)
    assert not caplog.records


@pytest.mark.parametrize("offered", [["viser-v0.0.1"], ["other", "more"]])
def test_a_page_of_another_viser_is_told_to_reload(live: Any, offered: list[str]) -> None:
    bench = live.bench()
    with join(live, bench, subprotocols=offered) as page, pytest.raises(ConnectionClosed) as caught:
        page.recv(timeout=5)
    assert caught.value.rcvd is not None and caught.value.rcvd.code == 4001 and "reload" in caught.value.rcvd.reason


def test_closing_the_bench_closes_its_scene(live: Any) -> None:
    bench = live.bench()
    with join(live, bench) as page:
        arrive(page, 1)
        live.http.delete(f"/api/v1/benches/{bench['id']}")
        with pytest.raises(ConnectionClosed):
            arrive(page, 10**6)
    with join(live, bench) as page, pytest.raises(ConnectionClosed) as caught:
        page.recv(timeout=5)
    assert caught.value.rcvd is not None and caught.value.rcvd.code == 4404


def test_nothing_stays_behind(live: Any) -> None:
    bench = live.bench()
    show = live.service.viewers.show_of(live.service.benches.get(bench["id"]))
    threads = []
    for _ in range(4):
        with join(live, bench) as page:
            arrive(page, 1)
        live.wait(lambda: not show._scenes)
        live.wait(lambda: not any(thread.name.startswith("websockets") for thread in threading.enumerate()))
        threads.append(threading.active_count())
    live.wait(lambda: threading.active_count() <= threads[0] + 1)


def test_faults_and_motion_reach_the_parts(live: Any) -> None:
    bench = live.bench(set={"events": []}, time_scale=0.002)
    with drawn(live, bench) as (scene, show):

        def shown() -> float:
            live.advance(seconds=0.05)
            show()
            return float(scene.nodes["/shuttle"].position[0])

        shown()
        film, (plus, minus) = scene.nodes["/film"], (scene.nodes[f"/beams/{side}"] for side in ("plus", "minus"))
        assert not scene.added and not film.visible
        color, opacity = tuple(plus.color), film.opacity
        for fault in ("added_mass", "stiffness", "damping"):
            live.command(bench["id"], fault=fault, severity=0.2)
        assert len({shown() for _ in range(8)}) > 5
        marks = dict(scene.added)
        assert set(marks) == {"/shuttle/added-mass", "/labels/0", "/labels/1", "/labels/2"}
        shown()
        assert all(scene.added[name] is node for name, node in marks.items())  # they are not sent again
        assert film.visible and film.opacity != opacity
        assert tuple(plus.color) == tuple(minus.color) != color
        live.command(bench["id"], heal="all")
        shown()
        assert not scene.added and not film.visible and tuple(plus.color) == color


def pose_of(live: Any, bench: dict[str, Any]) -> tuple[Any, Any]:
    session = live.service.benches.get(bench["id"])
    return session, device_of(session).pose()


def test_a_shuttle_in_the_plane_shifts_turns_and_warns(live: Any) -> None:
    """Near pull-in: y + theta X against the gap of 2.1 um, with X = 166.13 um; the arms turn magnified."""
    bench = live.bench("ch3-pull-in-map", paused=True)
    live.command(bench["id"], "step", ticks=765)
    session, pose = pose_of(live, bench)
    x, y, turn = (session.board.value(f"plant.{name}") for name in ("displacement", "shift", "rotation"))
    assert pose.shift_um == pytest.approx(y, rel=1e-6)
    right, left = y + 1e-3 * turn * 166.13, y - 1e-3 * turn * 166.13
    assert pose.combs_um == pytest.approx((right, left), rel=1e-4)
    assert pose.warnings == pytest.approx([(abs(eta) / 2.1) ** 0.5 for eta in (right, left)], abs=0.011)
    for factor in (pose.displacement_um / x, pose.turn / (1e-3 * turn)):
        assert f"×\u00a0{round(factor):g}" in pose.caption
    (fault,) = pose.faults
    assert fault.block.name == "point_adhesion" and fault.share == 1.0 and pose.contact == 0
    live.command(bench["id"], "step", ticks=400)
    session, pose = pose_of(live, bench)
    assert session.board.trip is not None
    # the short frees the shuttle, which may have sprung back within the sample of the contact
    assert pose.contact == 1 and pose.short in (1, 2, 3)
    assert pose.warnings == pytest.approx([(abs(eta) / 2.1) ** 0.5 for eta in pose.combs_um], abs=0.011)


def test_light_is_seen_where_a_sensor_uses_it(live: Any) -> None:
    for scenario, through in (("ch2-through-wafer", [True]), ("ch2-dual-beam", [True, True])):
        bench = live.bench(scenario, paused=True)
        live.command(bench["id"], "step", ticks=50)
        lasers = pose_of(live, bench)[1].lasers
        assert [laser.is_through for laser in lasers] == through
        assert len({laser.place_um for laser in lasers}) == len(lasers)
    bench = live.bench(paused=True)
    live.command(bench["id"], "step", ticks=50)
    assert pose_of(live, bench)[1].lasers == ()


def test_the_estimate_is_what_the_winner_predicted(live: Any) -> None:
    """Measured minus residual of the winner, magnified as the shuttle is."""
    bench = live.bench(paused=True)
    live.command(bench["id"], "step", ticks=700)
    session, pose = pose_of(live, bench)
    bank = session.board.spec.diagnosers["kalman"]
    winner = bank.params.hypotheses[int(session.board.value("kalman.winner"))].name
    predicted = session.board.value("sensor.displacement") - session.board.value(f"kalman.residual.{winner}")
    factor = pose.displacement_um / session.board.value("plant.displacement")
    assert pose.estimate_um == pytest.approx(predicted * factor, rel=1e-5)


def test_the_picture_of_a_pose_is_light(live: Any) -> None:
    """A frame of a plant in the plane: nodes are moved, not rebuilt, and few values go out."""
    bench = live.bench("ch3-case3-adhesion", paused=True)
    live.command(bench["id"], "step", ticks=10)
    with drawn(live, bench) as (scene, show):
        show()
        sent = listened(scene)
        for _ in range(5):
            live.command(bench["id"], "step", ticks=7)
            sent.clear()
            show()
            values = sum(np.size(v) for m in sent for v in vars(m).get("updates", {}).values())
            assert 0 < len(sent) <= MOST_MESSAGES and values < MOST_VALUES, (len(sent), values)


@pytest.mark.long
def test_the_picture_of_a_pose_takes_a_quarter_of_a_frame(live: Any) -> None:
    bench, spent = live.bench("ch3-case3-adhesion", paused=True), []
    live.command(bench["id"], "step", ticks=10)
    with drawn(live, bench) as (_, show):
        for _ in range(60):
            live.command(bench["id"], "step", ticks=7)
            start = time.thread_time()
            show()
            spent.append(time.thread_time() - start)
    assert sorted(spent)[30] < 4e-3


def test_the_rest_works_without_the_folder(serve: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    import importlib.util

    found = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util,
        "find_spec",
        lambda name, package=None: None if name == "server.view3d" else found(name, package),
    )
    for name in [name for name in sys.modules if name.startswith("server.view3d")]:
        monkeypatch.setitem(sys.modules, name, None)
    with serve() as live:
        bench = live.bench()
        assert bench["view3d"] is None
        assert live.http.get(f"/benches/{bench['id']}/3d/").status_code == 404
        with live.stream(bench["id"]) as stream:
            stream.until_type("status")
        with httpx.Client(trust_env=False) as client:
            assert client.get(live.address + "/health/ready").status_code == 200

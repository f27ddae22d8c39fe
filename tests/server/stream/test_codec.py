"""Binary frames: what goes in comes out, at the places the page reads them from."""

from __future__ import annotations

import struct
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as stn

from server.stream.codec import Moment, PanelFrame, Picture, decode, encode

NOW = Moment(1000, 0.01, 77.5)


def joined(*given: Any) -> bytes:
    return b"".join(encode(*given))


floats = st.floats(width=32, allow_nan=True, allow_infinity=True)


@st.composite
def panels(draw: st.DrawFn) -> PanelFrame:
    signals, columns = draw(st.integers(1, 5)), draw(st.integers(0, 20))
    return PanelFrame(
        panel=draw(st.integers(0, 65535)),
        start=draw(st.floats(-1e15, 1e15)),
        end=draw(st.floats(-1e15, 1e15)),
        trigger=draw(st.floats(allow_infinity=False)),
        revision=draw(st.integers(0, 2**31)),
        flags=draw(st.integers(0, 7)),
        columns=draw(stn.arrays(np.float32, (signals, 2, columns), elements=floats)),
        latest=draw(stn.arrays(np.float32, (signals,), elements=floats)),
    )


@given(st.lists(panels(), max_size=4), st.integers(0, 2**32 - 1), st.booleans(), st.integers(0, 2**52))
def test_a_frame_decodes_to_what_was_encoded(
    given_panels: list[PanelFrame], number: int, running: bool, head: int
) -> None:
    shown = [(one.panel, one.revision, one) for one in given_panels]
    frame = decode(joined(number, running, Moment(head, 0.01, 12.5), shown))
    assert (frame.frame, frame.running, frame.head, frame.dt_ms, frame.cut_s) == (number, running, head, 0.01, 12.5)
    for found, meant in zip(frame.panels, given_panels, strict=True):
        assert (found.panel, found.start, found.end, found.flags) == (meant.panel, meant.start, meant.end, meant.flags)
        assert found.revision == meant.revision
        np.testing.assert_equal(found.trigger, meant.trigger)
        np.testing.assert_array_equal(found.columns, meant.columns)
        np.testing.assert_array_equal(found.latest, meant.latest)


def test_the_layout_is_the_one_agreed_on() -> None:
    """Offsets written out by hand, as the page has them."""
    columns = np.arange(12, dtype=np.float32).reshape(3, 2, 2)
    latest = np.array([1.5, 2.5, 3.5], np.float32)
    data = joined(7, True, NOW, [(4, 3, Picture(10, 20, 12.5, 1, columns, latest))])
    assert len(data) % 8 == 0
    assert struct.unpack_from("<BBHIddd", data, 0) == (2, 1, 1, 7, 1000.0, 0.01, 77.5)
    assert struct.unpack_from("<HHI", data, 32) == (4, 3, 2)
    assert struct.unpack_from("<dddd", data, 40) == (10.0, 20.0, 12.5, 3.0)
    assert struct.unpack_from("<II", data, 72) == (1, 0)
    assert np.frombuffer(data, "<f4", 12, 80).tolist() == list(range(12))
    assert np.frombuffer(data, "<f4", 3, 80 + 48).tolist() == [1.5, 2.5, 3.5]
    assert len(data) == 80 + 48 + 16


@pytest.mark.parametrize("cut", [0, 10, 31])
def test_a_cut_header_is_refused(cut: int) -> None:
    with pytest.raises(ValueError, match="shorter"):
        decode(joined(1, False, NOW, [])[:cut])


def test_another_version_and_left_over_bytes_are_refused() -> None:
    data = joined(1, False, NOW, [])
    with pytest.raises(ValueError, match="version 3"):
        decode(b"\x03" + data[1:])
    with pytest.raises(ValueError, match="left over"):
        decode(data + b"\0")

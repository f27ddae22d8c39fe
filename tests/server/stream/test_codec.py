"""Binary frames: what goes in comes out, at the places the page reads them from."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as stn

from server.stream.codec import PanelFrame, decode, encode

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
    frame = decode(encode(number, running, head, 0.01, given_panels))
    assert (frame.frame, frame.running, frame.head, frame.dt_ms) == (number, running, head, 0.01)
    for found, meant in zip(frame.panels, given_panels, strict=True):
        assert (found.panel, found.start, found.end, found.flags) == (
            meant.panel,
            meant.start,
            meant.end,
            meant.flags,
        )
        assert found.revision == meant.revision
        np.testing.assert_equal(found.trigger, meant.trigger)
        np.testing.assert_array_equal(found.columns, meant.columns)
        np.testing.assert_array_equal(found.latest, meant.latest)


def test_the_layout_is_the_one_agreed_on() -> None:
    """Offsets written out by hand, as the page has them."""
    columns = np.arange(12, dtype=np.float32).reshape(3, 2, 2)
    latest = np.array([1.5, 2.5, 3.5], np.float32)
    data = encode(7, True, 1000, 0.01, [PanelFrame(4, 10, 20, 12.5, 3, 1, columns, latest)])
    assert len(data) % 8 == 0
    assert struct.unpack_from("<BBHIdd", data, 0) == (1, 1, 1, 7, 1000.0, 0.01)
    assert struct.unpack_from("<HHI", data, 24) == (4, 3, 2)
    assert struct.unpack_from("<dddd", data, 32) == (10.0, 20.0, 12.5, 3.0)
    assert struct.unpack_from("<II", data, 64) == (1, 0)
    assert np.frombuffer(data, "<f4", 12, 72).tolist() == list(range(12))
    assert np.frombuffer(data, "<f4", 3, 72 + 48).tolist() == [1.5, 2.5, 3.5]
    assert len(data) == 72 + 48 + 16


@pytest.mark.parametrize("cut", [0, 10, 23])
def test_a_cut_header_is_refused(cut: int) -> None:
    with pytest.raises(ValueError, match="shorter"):
        decode(encode(1, False, 0, 1.0, [])[:cut])


def test_another_version_and_left_over_bytes_are_refused() -> None:
    data = encode(1, False, 0, 1.0, [])
    with pytest.raises(ValueError, match="version 2"):
        decode(b"\x02" + data[1:])
    with pytest.raises(ValueError, match="left over"):
        decode(data + b"\0")

"""The catalogue lists blocks as people are shown them."""

from __future__ import annotations

import itertools

from core.registry import blocks, catalog

LAST = 1000
"""Place of a block without a declared place."""


def test_faults_come_in_groups_the_usual_first() -> None:
    """Each fault of the library has a heading and a place of its own; a heading comes once."""
    cards = catalog("faults")
    assert [card.name for card in cards[:3]] == ["added_mass", "stiffness", "damping"]
    headings = [heading for heading, _ in itertools.groupby(card.group for card in cards)]
    assert len(headings) == len(set(headings))
    assert headings[0] == "The usual"
    assert "" not in headings
    places = [entry.place for entry in blocks("faults").values()]
    assert len(set(places)) == len(places)
    assert max(places) < LAST


def test_controllers_come_in_teaching_order() -> None:
    """From no feedback over fixed gains to adaptation and sliding; a later one builds on those before."""
    names = [card.name for card in catalog("control")]
    taught = ["open_loop", "pid", "mrac", "mrac_velocity", "indirect_mrac", "vsc", "stvsc", "vsmrc", "self_sliding"]
    assert [name for name in names if name in taught] == taught
    assert [name for name in names if name in {"drive_loop", "forced_drive"}] == ["forced_drive", "drive_loop"]
    assert max(entry.place for entry in blocks("control").values()) < LAST


def test_families_without_places_are_in_the_order_of_their_names() -> None:
    """What says nothing of its place keeps the order of the alphabet."""
    for family in ("plant", "sense", "reference"):
        names = [card.name for card in catalog(family)]
        assert names == sorted(names)

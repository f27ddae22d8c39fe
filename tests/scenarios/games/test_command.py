"""``combbench game``: lists, explains, judges by the same rule as a call, tells, and refuses in one line."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from scenarios.games import GAMES
from server.cli.main import app


@pytest.fixture
def call():
    return lambda *args: CliRunner().invoke(app, ["game", *map(str, args)])


def test_the_points_are_those_of_a_call_to_the_bit(call):
    filter_game = GAMES["be-the-filter"]
    done = call("be-the-filter", "--seed", 4, "--set", "assumed_noise_scale=2.5", "--set", "mass=1.1", "--json")
    assert done.exit_code == 0, done.stderr
    document = json.loads(done.stdout)
    expected = filter_game.judge(4, filter_game.read(4, {"assumed_noise_scale": 2.5, "mass": 1.1}))
    assert document["points"] == expected.points and document["figures"] == expected.figures
    assert document["handed_in"]["mass"] == 1.1 and document["handed_in"]["stiffness"] == 1.0


def test_it_lists_explains_and_tells(call):
    assert [row["id"] for row in json.loads(call("--json").stdout)] == [*GAMES]
    explained = call("fool-the-bank", "--seed", 2).stdout
    for kind in GAMES["fool-the-bank"].kinds(2):
        assert f"fault={kind.name}" in explained
    told = json.loads(call("fool-the-bank", "--seed", 2, "--hidden", "--json").stdout)
    assert told == [fact.model_dump() for fact in GAMES["fool-the-bank"].hidden(2)]


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("chess",), "game: unknown game 'chess'"),
        (("be-the-filter", "--seed", -1), "seed: must be a whole number from 0"),
        (("be-the-filter", "--set", "mass=3"), "mass: must be <= 2"),
        (("fool-the-bank", "--set", "fault=rust"), "fault: unknown fault 'rust'"),
    ],
)
def test_bad_input_is_one_line(call, arguments, text):
    done = call(*arguments)
    assert done.exit_code == 2 and text in done.stderr and done.stderr.count("\n") == 1

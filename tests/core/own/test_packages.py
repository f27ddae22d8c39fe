"""A scenario carries the installed packages whose blocks it names, and is refused where they are others."""

from __future__ import annotations

import hashlib
import shutil
from typing import Any

import pytest

from core.errors import InputError
from scenarios.edit import with_values
from scenarios.key import content_hash
from scenarios.library import get
from scenarios.schema import Scenario
from tests.core.own.installed import TEMPLATE, Installed

HASH = "0" * 64
CARRIED = """
from core.errors import InputError
from scenarios.edit import with_values
from scenarios.key import content_hash, run_key
from scenarios.library import get
from scenarios.schema import Scenario
base, values, more = words
try:
    one = Scenario.load({**with_values(get(base), values).document, **more})
except InputError as error:
    answer = str(error)
else:
    answer = [one.document.get("packages"), run_key(content_hash(one.document), 1)]
"""


def carried(
    installed: Installed, values: dict[str, Any], more: dict[str, Any] | None = None, base: str = "first-look"
) -> Any:
    """Return the packages a scenario carries where the template is installed, and the key of its run; or why not."""
    return installed.answer(CARRIED, base, values, more or {})


@pytest.fixture
def mark() -> dict[str, str]:
    """Return the mark of the template: SHA-256 over the name of the file and its text."""
    text = (TEMPLATE / "lead.py").read_text("utf-8")
    return {"version": "0.1.0", "source": hashlib.sha256(f"lead\n{text}".encode()).hexdigest()}


NAMED: list[dict[str, Any]] = [
    {"controller.kind": "lead"},
    {"controllers.lead.ratio": 0.5},
    {"events": [{"at_sample": 5, "switch": "lead"}]},
    {"events": [{"at_sample": 5, "set": {"controllers.lead.ratio": 0.5}}]},
    {"events": [{"when": "lead.voltage > 1", "fault": "added_mass", "severity": 0.05}]},
    {"twins.other.controller.kind": "lead"},
]


def test_a_scenario_that_names_a_block_of_a_package_carries_it(installed: Installed, mark: dict[str, str]) -> None:
    for values in NAMED:
        assert carried(installed, values)[0] == {"combbench-lead": mark}, values


def test_other_scenarios_carry_nothing_and_keep_their_hash_and_key(installed: Installed) -> None:
    from scenarios.key import run_key

    for values in ({}, {"controller.kind": "pid"}, {"title": "lead"}):
        here = with_values(get("first-look"), values).document
        assert "packages" not in here
        assert carried(installed, values) == [None, run_key(content_hash(here), 1)]


def test_a_unit_of_its_own_takes_the_place_of_the_unit_of_a_package(installed: Installed) -> None:
    unit = {"units": {"lead": {"source": (TEMPLATE / "lead.py").read_text("utf-8")}}}
    assert carried(installed, {}, {**unit, "controller": {"kind": "lead"}})[0] is None


def test_the_key_of_a_run_follows_the_source_and_the_version(installed: Installed) -> None:
    keys = [carried(installed, {"controller.kind": "lead"})[1]]
    file = installed.source / "lead.py"
    file.write_text(file.read_text("utf-8") + "\n# the same law\n", "utf-8")
    keys.append(carried(installed, {"controller.kind": "lead"})[1])
    installed.rename("0.1.1")
    keys.append(carried(installed, {"controller.kind": "lead"})[1])
    assert len({*keys}) == 3


def test_points_of_a_campaign_that_name_it_have_its_source_in_their_keys(installed: Installed) -> None:
    sweep = {
        "scenario": "first-look",
        "variants": [{"name": k, "set": {"controller.kind": k}} for k in ("pid", "lead")],
    }
    code = """
from scenarios.campaign.points import Contents
from scenarios.campaign.sweep import Sweep
answer = list(Contents(Sweep(words[0]).points))
"""
    before = installed.answer(code, sweep)
    installed.rename("0.1.1")
    after = installed.answer(code, sweep)
    assert [one == other for one, other in zip(before, after, strict=True)] == [True, False]


def test_a_package_that_is_another_here_is_refused_in_one_line(installed: Installed, mark: dict[str, str]) -> None:
    document = {"controller": {"kind": "lead"}, "packages": {"combbench-lead": mark}}
    assert carried(installed, {}, document)[0] == {"combbench-lead": mark}
    file = installed.source / "lead.py"
    file.write_text(file.read_text("utf-8").replace("-5.0", "-5.5"), "utf-8")
    line = "has another source here, by its hash, than the version 0.1.0 this scenario was made with"
    assert carried(installed, {}, document) == f"packages.combbench-lead: {line}"
    installed.rename("0.2.0")
    line = "packages.combbench-lead: is version 0.2.0 here; this scenario was made with version 0.1.0"
    assert carried(installed, {}, document) == line


def test_the_source_is_the_whole_package_whatever_its_line_ends(installed: Installed) -> None:
    package = installed.source / "made"
    (package / "deep").mkdir(parents=True)
    shutil.move(installed.source / "lead.py", package / "lead.py")
    (package / "__init__.py").write_text("", "utf-8")
    (package / "deep" / "__init__.py").write_text("TAU = 1.0\n", "utf-8")
    installed.enter("made.lead:Lead")

    def source() -> str:
        return str(carried(installed, {"controller.kind": "lead"})[0]["combbench-lead"]["source"])

    first = source()
    (package / "lead.py").write_bytes((package / "lead.py").read_bytes().replace(b"\n", b"\r\n"))
    assert source() == first
    (package / "deep" / "__init__.py").write_text("TAU = 2.0\n", "utf-8")
    assert source() != first


REFUSED: list[tuple[Any, str]] = [
    ({"lead": {"version": "0.1.0", "source": HASH}}, "packages.lead: is not installed here"),
    ({"lead": "0.1.0"}, "packages.lead: "),
    ({"lead": {"version": "0.1.0"}}, "packages.lead.source: "),
    (
        {"lead": {"version": "1", "source": HASH, "url": "x"}},
        "packages.lead.url: unknown field; allowed: version, source",
    ),
    ({"Lead_": {"version": "1", "source": HASH}}, "packages.'Lead_': must be the name of a package, of small"),
    (["lead"], "packages: must be a table, got ['lead']"),
]


def test_a_package_that_is_missing_or_malformed_is_refused_before_anything_else() -> None:
    for packages, line in REFUSED:
        document = {**get("first-look").document, "controller": {"kind": "lead"}, "packages": packages}
        with pytest.raises(InputError) as raised:
            Scenario.load(document)
        assert str(raised.value).startswith(line)
        assert "\n" not in str(raised.value)

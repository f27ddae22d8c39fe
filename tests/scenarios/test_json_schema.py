"""The JSON Schemas agree with the readers: on every document of the product, and on spoiled documents."""

from __future__ import annotations

import itertools
import json
import math
import re
from collections.abc import Iterator
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
from jsonschema_rs import Draft202012Validator, meta
from pydantic import Field, create_model
from typer.testing import CliRunner

from core import registry
from core.board.document import sections
from core.errors import InputError
from core.nesting import read_toml
from scenarios import lectures, library, sheets
from scenarios.campaign.sweep import CampaignHead, Sweep
from scenarios.json_schema.bench import ABOUT
from scenarios.json_schema.components import components
from scenarios.json_schema.definitions import Definitions
from scenarios.json_schema.documents import DOCUMENTS, json_schema
from scenarios.lecture import Lecture, LectureHead
from scenarios.schema import Scenario, ScenarioHead
from scenarios.sheets.read import read_sheet
from scenarios.sheets.sheet import SheetHead
from server.api.examples import EXAMPLES
from server.cli.main import app

PAGES = (
    ("scenario.md", "toml", "scenario"),
    ("scaling.md", "toml", "campaign"),
    ("lectures.md", "toml", "lecture"),
    ("sheets.md", "markdown", "sheet"),
)
"""Documents with examples: the language of the example, and its schema."""
DOCS = Path(__file__).resolve().parents[2] / "docs"


@cache
def validator(name: str) -> Draft202012Validator:
    """Return a validator of a kind of document, or of a step of a sheet."""
    steps = {"$ref": "#/$defs/Step", "$defs": json_schema("sheet")["$defs"]}
    return Draft202012Validator(steps if name == "step" else json_schema(name))


def finite(document: Any) -> Any:
    """Return a document without infinite numbers, which TOML has and the validator takes for null."""
    if isinstance(document, dict):
        return {key: finite(value) for key, value in document.items()}
    if isinstance(document, list):
        return [finite(value) for value in document]
    return math.copysign(1e300, document) if isinstance(document, float) and math.isinf(document) else document


def refusal(name: str, document: Any) -> str:
    """Return the first error of a schema; nothing where it accepts a document."""
    error = next(iter(validator(name).iter_errors(finite(document))), None)
    return "" if error is None else f"{error.instance_path}: {error.message}"


def texts(package: Any, end: str) -> Iterator[tuple[str, str]]:
    for file in files(package).iterdir():
        if file.name.endswith(end):
            yield file.name, file.read_text("utf-8")


def parts(sheet: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the tables of a sheet, each with the name of its schema."""
    yield "sheet", read_toml(sheet.split("+++")[1], "sheet")
    for step in re.findall(r"^```step\n(.*?)^```", sheet, re.DOTALL | re.MULTILINE):
        yield "step", read_toml(step, "step")


def written() -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield every document of the library and of the documents about it."""
    for name, text in texts(library, ".toml"):
        yield name, "scenario", read_toml(text, name)
        yield name, "scenario", library.get(name.removesuffix(".toml")).document
    for name, text in texts(lectures, ".toml"):
        yield name, "lecture", read_toml(text, name)
    for name, text in texts(sheets, ".md"):
        yield from ((name, kind, table) for kind, table in parts(text))
    for page, language, name in PAGES:
        text = (DOCS / page).read_text("utf-8")
        for _, block in re.findall(rf"^(`{{3,5}}){language}\n(.*?)^\1$", text, re.DOTALL | re.MULTILINE):
            found = parts(block) if name == "sheet" else [(name, read_toml(block, page))]
            yield from ((page, kind, table) for kind, table in found)
    for example in EXAMPLES["start_sweep"]:
        sweep = example["sweep"]
        yield "examples", "campaign", read_toml(sweep, "") if isinstance(sweep, str) else sweep


def test_every_document_of_the_product_is_valid() -> None:
    counts = dict.fromkeys((*DOCUMENTS, "step"), 0)
    for where, name, document in written():
        assert refusal(name, document) == "", where
        counts[name] += 1
    least = {"scenario": 250, "campaign": 2, "sheet": 9, "step": 30, "lecture": 6}
    assert all(counts[name] >= number for name, number in least.items()), counts


@pytest.mark.parametrize("name", DOCUMENTS)
def test_a_schema_is_json_schema_and_says_what_every_field_means(name: str) -> None:
    schema = json_schema(name, "http://127.0.0.1/schema")
    meta.validate(schema)
    assert (schema["$id"], schema["title"][:2]) == ("http://127.0.0.1/schema", "A " if name != "sheet" else "Th")
    assert json_schema(name)["$id"] == f"urn:combbench:schema:{name}"
    tables = {"": schema, **schema["$defs"]}
    described = [one for one in tables if one not in ("LibraryEvent", "SlotsTable") and not one.endswith("Table")]
    silent = [
        f"{one}.{key}"
        for one in described
        for key, field in tables[one].get("properties", {}).items()
        if "oneOf" not in tables[one] and not field.get("description") and "$ref" not in field
    ]
    assert silent == []
    assert json.loads(json.dumps(schema)) == schema


def test_every_field_of_every_reader_is_in_its_schema() -> None:
    heads = {"scenario": ScenarioHead, "campaign": CampaignHead, "sheet": SheetHead, "lecture": LectureHead}
    for name, head in heads.items():
        fields = {info.alias or field for field, info in head.model_fields.items()}
        assert fields <= json_schema(name)["properties"].keys(), name
    assert ABOUT.keys() == {*sections()} <= json_schema("scenario")["properties"].keys()
    for family, suffix in (("control", "Controller"), ("sense", "Sensor"), ("diagnose", "Diagnoser")):
        for name, block in registry.blocks(family).items():
            table = json_schema("scenario")["$defs"]["".join(map(str.capitalize, name.split("_"))) + suffix]
            assert table["properties"].keys() == {"kind", "every", *block.Params.model_fields}, name


def test_the_unit_of_a_parameter_is_in_its_meaning() -> None:
    table = json_schema("scenario")["$defs"]["PidController"]["properties"]
    assert table["proportional_v_um"]["description"] == "proportional gain, V/µm"


GOOD: list[dict[str, Any]] = [
    {},
    {"$schema": "./scenario.schema.json"},
    {"controller": {}},
    {"controllers": {"pid": {"pole": 1.0}}},
    {"sensor": {"noise_um": 0.1}},
    {"plant": {"gap_um": 2.0, "drive": "held"}},
    {"reference": {"kind": "sine", "amplitude_v": 1, "frequency_hz": 100, "every": 2}},
    {"diagnosers": {"k": {"kind": "mmae", "process_noise_v": 0.3}}},
    {"events": [{"at_ms": 1, "fault": "broken_truss", "severity": 0.1, "parameters": {"extent": "end"}}]},
    {"events": [{"at_ms": 1, "fault": "added_mass", "severity": 0.1, "switch": "pid"}]},
    {"device": {"id": "lcr-350", "geometry": {"fingers": 30}}},
    {"device": {"id": "gyro-2-2"}, "rate": {"kind": "constant", "deg_per_s": 3}},
    {"device": {"id": "gyro-2-2"}, "rate": {}, "slots": {"drive": "drive_tracking"}, "drive": {"limit_un": 10}},
    {"twins": {"a": {"controller": {"kind": "pid"}, "diagnosers": {}}}},
    {"expect": [{"metric": "control.rms_error_um", "min": 1, "published_range": [0, float("inf")]}]},
    {"study": {"kind": "swept_sine"}},
    {"sample_rate_khz": 50, "environment": {"temperature_k": 310}},
]
BAD: list[dict[str, Any]] = [
    {"contrller": {}},
    {"$schema": 5},
    {"schema": 2},
    {"controller": {"kind": "pidd"}},
    {"controller": {"kind": "pid", "polee": 1}},
    {"controller": {"kind": "pid", "pole": "1"}},
    {"controller": {"kind": "pid", "pole": True}},
    {"controller": {"pole": 1}},
    {"controller": {"kind": "drive_loop"}},
    {"controller": []},
    {"controllers": {"pid": {"kind": "pid"}}},
    {"controllers": {"pidd": {}}},
    {"sensor": {"kind": "velocimeter"}},
    {"sensor": {"kind": "ideal", "noise_nm": 1}},
    {"sensor": {"kind": "ideal", "every": 0}},
    {"plant": {"drive": "x"}},
    {"plant": {"model": "nonlinear", "gap": 2}},
    {"reference": {"amplitude_v": 1}},
    {"diagnosers": {"K": {"kind": "mmae"}}},
    {"diagnosers": {"k": {"kind": "mmae", "proces": 0.3}}},
    {"diagnosers": {"k": {}}},
    {"diagnosers": {"k": {"kind": "mmae", "hypotheses": [{"name": "healthy", "mas": 1.0}, {"name": "m"}]}}},
    {"events": [{"at_ms": 1}]},
    {"events": [{"fault": "added_mass", "severity": 0.1}]},
    {"events": [{"at_ms": 1, "fault": "added_mas", "severity": 0.1}]},
    {"events": [{"at_ms": 1, "fault": "added_mass"}]},
    {"events": [{"at_ms": 1, "fault": "added_mass", "severity": 1e9}]},
    {"events": [{"at_ms": 1, "fault": "broken_truss", "severity": 0.1, "parameters": {"extnt": "end"}}]},
    {"events": [{"at_ms": 1, "fault": "broken_truss", "severity": 0.1, "parameters": {"extent": "middle"}}]},
    {"events": [{"at_ms": 1, "switch": "pidd"}]},
    {"events": [{"at_ms": 1, "heal": ["added_mas"]}]},
    {"events": [{"at_ms": 1, "faullt": "added_mass"}]},
    {"samples": "100"},
    {"samples": True},
    {"samples": 0},
    {"samples": 1.5},
    {"device": {"id": "ch33"}},
    {"device": {"mas_kg": 1}},
    {"device": {"id": "lcr-350", "geometry": {"fingrs": 3}}},
    {"guard": {"travl_um": 1}},
    {"environment": {"temperature_c": 300}},
    {"twins": {"a": {"reference": {}}}},
    {"twins": {"a": {"controller": {"kind": "pidd"}}}},
    {"expect": [{"metric": "x", "mini": 1}]},
    {"metrics": {"since": 1}},
    {"study": {"kind": "swept"}},
    {"study": {"kind": "swept_sine", "strt_hz": 1}},
    {"slots": {"sense": "open_loop_rate"}},
    {"sample_rate_hz": 50},
    {"packages": {"UPPER": {}}},
    {"units": {"u": {}}},
]


def loads(document: dict[str, Any]) -> bool:
    try:
        Scenario.load(document)
    except InputError:
        return False
    return True


@pytest.mark.parametrize("values", GOOD, ids=str)
def test_schema_and_reader_accept_the_same_scenarios(values: dict[str, Any]) -> None:
    document = {"samples": 100, **values}
    assert (refusal("scenario", document), loads(document)) == ("", True)


@pytest.mark.parametrize("values", BAD, ids=str)
def test_schema_and_reader_refuse_the_same_scenarios(values: dict[str, Any]) -> None:
    document = {"samples": 100, **values}
    assert (refusal("scenario", document) != "", loads(document)) == (True, False)


UNKNOWABLE: dict[str, dict[str, Any]] = {
    "a rule between fields": {"duration_ms": 1.0},
    "a path": {"events": [{"at_ms": 1, "set": {"sensor.nothing": 1}}]},
    "a condition": {"events": [{"when": "plant.displacment > 1", "switch": "pid"}]},
    "whether a section belongs to the plant": {"rate": {}},
    "whether a block goes with the plant": {"controller": {"kind": "whole_angle"}},
    "a number too small to compute with": {"sensor": {"noise_um": 1e-70}},
    "a name that is taken": {"diagnosers": {"plant": {"kind": "mmae"}}},
    "a diagnoser by its name": {"metrics": {"beside": "kalman"}},
    "the text of a unit": {"units": {"u": {"source": "x"}}},
}


@pytest.mark.parametrize("kind", UNKNOWABLE)
def test_the_reader_alone_knows(kind: str) -> None:
    document = {"samples": 100, **UNKNOWABLE[kind]}
    assert (refusal("scenario", document), loads(document)) == ("", False)


def leaves(table: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the places of the values of a document, and of its tables."""
    for key, value in table.items() if isinstance(table, dict) else enumerate(table):
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from leaves(value, (*path, key))


def spoiled(document: Any, path: tuple[Any, ...], how: str) -> Any:
    """Return a document with a misspelt key, or a value of another type, at a place."""
    changed = json.loads(json.dumps(document))
    *above, last = path
    table = changed
    for key in above:
        table = table[key]
    if how == "type":
        table[last] = 5 if isinstance(table[last], str | dict | list) else "text"
    elif isinstance(last, str):
        table[f"{last}z"] = table.pop(last)
    return changed


@pytest.mark.parametrize("name", ["ch5-seven-step", "ch3-mrac-spring-x2", "gyro-first-look"])
def test_what_the_schema_accepts_of_a_spoiled_scenario_the_reader_accepts_too(name: str) -> None:
    document = {key: value for key, value in library.get(name).document.items() if key != "expect"}  # it names paths
    places = [path for path in leaves(document) if "set" not in path]
    seen = 0
    for path, how in itertools.product(places[::2], ("key", "type")):
        changed = spoiled(document, path, how)
        if refusal("scenario", changed) == "" and changed != document:
            assert loads(changed) or path[-1] in ("name", "when", "metric"), (path, how)
        seen += 1
    assert seen > 40


def test_a_campaign_is_refused_for_its_scenario_too() -> None:
    good = {"scenario": {"samples": 100}, "seeds": "1:4", "grid": {"sensor.noise_um": [0.1]}}
    assert refusal("campaign", good) == "" and Sweep({**good, "$schema": "./campaign.schema.json"}).seeds == range(1, 5)
    for bad in ({"scenario": "first-lok"}, {"seeds": "1-4"}, {"seedz": 1}, {"latin_hypercube": {"points": 3}},
                {"scenario": {"contrller": {}}}):  # fmt: skip
        assert refusal("campaign", {**good, **bad}) != "", bad
        with pytest.raises(InputError):
            Sweep({**good, **bad})
    assert refusal("campaign", {"scenario": "bench.toml"}) == ""  # a file beside the campaign


def test_sheets_and_lectures_are_refused_for_the_same_slips() -> None:
    sheet = EXAMPLES["open_sheet"][0]["text"]
    for old, new in (("minutes", "minuts"), ('"first-look"', '"first-lok"'), ('"hold"', '"holdd"'), ("for_ms", "for_s"),
                     ("points = 1.0", 'points = "1"')):  # fmt: skip
        slip = sheet.replace(old, new)
        assert any(refusal(kind, table) for kind, table in parts(slip)), new
        if "lok" not in new:
            with pytest.raises(InputError):
                read_sheet(slip, "slip")
    (lecture,) = (text for name, text in texts(lectures, ".toml") if name == "ch2-sensing.toml")
    document = read_toml(lecture, "lecture")
    assert Lecture("same", {**document, "$schema": "x"}).head == Lecture("same", document).head
    for key, value in (("panels", ["nothing"]), ("scenario", "nope"), ("says", "x"), ("events", [{"at_ms": 1}])):
        slip = {**document, "cue": [{**document["cue"][0], key: value}]}
        assert refusal("lecture", slip) != "", key
        with pytest.raises(InputError):
            _ = Lecture("slip", slip).states


def test_the_address_of_a_schema_changes_no_scenario() -> None:
    plain, addressed = ({"samples": 10, **more} for more in ({}, {"$schema": "./scenario.schema.json"}))
    assert Scenario.load(plain).document == Scenario.load(addressed).document


def test_a_written_scenario_begins_with_the_file_of_its_schema() -> None:
    text = library.get("first-look").toml("a remark")
    assert text.split("\n")[:2] == ["#:schema ./scenario.schema.json", "# a remark"]
    assert Scenario.load(text).document == library.get("first-look").document


def test_units_of_a_bench_may_have_any_kind_and_parameters() -> None:
    own = {"units": {"mine": {"source": "..."}}, "controller": {"kind": "mine", "gain": 1}}
    assert refusal("scenario", own) == ""
    assert refusal("scenario", {**own, "contrller": {}}) != ""


def test_parts_of_two_models_may_have_one_name() -> None:
    def named_after(field: str) -> Any:
        part = create_model("Part", **{field: (float, Field(1.0, description=field))})
        return create_model("Whole", part=(part, Field(description="a part")))

    known = Definitions()
    first, second, again = (known.model(named_after(field))["properties"]["part"] for field in ("one", "other", "one"))
    assert (first["$ref"], second["$ref"], again["$ref"]) == ("#/$defs/Part", "#/$defs/Part2", "#/$defs/Part")
    assert [*known.found["Part2"]["properties"]] == ["other"]


def test_components_are_plain_and_take_the_library() -> None:
    found = components()
    text = json.dumps(found)
    assert [word for word in ('"$defs"', '"if"', '"not"', '"allOf"', '"propertyNames"') if word in text] == []
    for name, schema in found.items():
        assert schema["title"] == name and re.fullmatch(r"[A-Z][A-Za-z0-9]*", name), name
        if "oneOf" in schema:
            key = schema["discriminator"]["propertyName"]
            for kind, ref in schema["discriminator"]["mapping"].items():
                member = found[ref.rpartition("/")[2]]
                assert member["properties"][key]["const"] == kind and key in member["required"], ref
    whole = {"$ref": "#/components/schemas/Scenario", "components": {"schemas": found}}
    for name in library.ids():
        Draft202012Validator(whole).validate(library.get(name).document)


def test_the_command_lists_prints_and_writes_schemas(tmp_path: Path) -> None:
    def call(*words: str) -> Any:
        return CliRunner().invoke(app, ["schema", *words], catch_exceptions=False)

    assert [line.split()[0] for line in call().stdout.splitlines()] == [*DOCUMENTS]
    assert json.loads(call("campaign").stdout) == json_schema("campaign")
    assert call("--out", str(tmp_path / "new")).exit_code == 0
    assert {file.name for file in (tmp_path / "new").iterdir()} == {f"{name}.schema.json" for name in DOCUMENTS}
    assert json.loads((tmp_path / "new" / "sheet.schema.json").read_text("utf-8")) == json_schema("sheet")
    wrong = call("scenarioo")
    assert (wrong.exit_code, "did you mean scenario" in wrong.stderr) == (2, True)
    (tmp_path / "file").write_text("")
    assert "cannot write" in call("--out", str(tmp_path / "file")).stderr

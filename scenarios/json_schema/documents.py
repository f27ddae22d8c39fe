"""JSON Schemas of the documents that people write: scenario, campaign, sheet and lecture.

They follow from the models that read the documents and from the registry of blocks. A schema knows the names, the
types, the ranges and the kinds; rules between fields and paths in ``set`` are for the reader.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from core.errors import unknown
from scenarios.campaign.sweep import CampaignHead
from scenarios.json_schema.bench import bench
from scenarios.json_schema.blocks import study
from scenarios.json_schema.definitions import Definitions, Schema, ref
from scenarios.json_schema.events import event, library_event
from scenarios.lecture import LectureHead
from scenarios.library import ids
from scenarios.reading import ADDRESS
from scenarios.schema import ScenarioHead
from scenarios.seeds import BOTH_ENDS
from scenarios.sheets.sheet import AnyStep, SheetHead

DIALECT = "https://json-schema.org/draft/2020-12/schema"
FILE: Schema = {"type": "string", "pattern": r"\.toml$", "description": "A file, from the folder of the campaign."}
OF_EDITORS: Schema = {"type": "string", "description": "address of this JSON Schema, for editors"}
OWN_BLOCK: Schema = {
    "type": "object",
    "description": "A block of a unit of your own, whose parameters its text declares.",
}


def scenario(definitions: Definitions) -> Schema:
    """Return the schema of a scenario."""
    head: Schema = definitions.model(ScenarioHead)
    sections, choosing = bench(definitions)
    event(definitions)
    exact = {key: sections[key] for key in choosing}
    exact["events"] = {"items": library_event(definitions)}
    own = definitions.add("OwnBlock", OWN_BLOCK)
    for key in choosing:
        section = dict(sections[key])
        sections[key] = {"description": section.pop("description"), "anyOf": [section, own]}
    properties = {**head["properties"], **sections}
    properties["events"] = {**properties["events"], "items": ref("ScenarioEvent")}
    properties["study"] |= {"anyOf": [study(definitions), {"type": "null"}]}
    return {
        **_document({**head, "description": "A bench, its events and its expectations.", "properties": properties}),
        "if": {"not": {"required": ["units"]}},
        "then": {"properties": exact},
    }


def campaign(definitions: Definitions) -> Schema:
    """Return the schema of a campaign."""
    definitions.add("Scenario", scenario(definitions))
    head = definitions.model(CampaignHead)
    head["properties"]["scenario"] = {
        "description": head["properties"]["scenario"]["description"],
        "anyOf": [library_id(definitions), FILE, ref("Scenario")],
    }
    seeds = head["properties"]["seeds"]
    head["properties"]["seeds"] = {
        "description": seeds["description"],
        "anyOf": [{"type": "string", "pattern": f"^{BOTH_ENDS}$"}, {"$ref": seeds["$ref"]}],
    }
    return _document(head)


def sheet(definitions: Definitions) -> Schema:
    """Return the schema of the front matter of a sheet; the definition ``Step`` is the schema of its steps."""
    head = definitions.model(SheetHead)
    definitions.add("Step", definitions.model(AnyStep))
    definitions.found["SheetBench"]["properties"]["scenario"] |= library_id(definitions)
    return _document(head)


def lecture(definitions: Definitions) -> Schema:
    """Return the schema of a lecture."""
    head = definitions.model(LectureHead)
    scenario(definitions)
    cue = definitions.found["Cue"]["properties"]
    cue["scenario"] = {"description": cue["scenario"]["description"], **library_id(definitions)}
    cue["events"] |= {"items": {"allOf": [ref("ScenarioEvent"), ref("LibraryEvent")]}}
    return _document(head)


def library_id(definitions: Definitions) -> Schema:
    """Add the ids of the library; return the reference."""
    return definitions.add("ScenarioId", {"description": "An id of the library of scenarios.", "enum": [*ids()]})


def _document(head: Schema) -> Schema:
    return {**head, "properties": {ADDRESS: OF_EDITORS, **head["properties"]}}


DOCUMENTS: dict[str, Callable[[Definitions], Schema]] = {
    "scenario": scenario,
    "campaign": campaign,
    "sheet": sheet,
    "lecture": lecture,
}
"""Makers of the schemas, by name."""
TITLES = {
    "scenario": "A scenario of CombBench",
    "campaign": "A campaign of CombBench",
    "sheet": "The front matter of a lab sheet of CombBench",
    "lecture": "A lecture of CombBench",
}


def json_schema(name: str, address: str = "") -> Schema:
    """Return the schema of a kind of document.

    Parameters
    ----------
    name : str
        ``scenario``, ``campaign``, ``sheet`` or ``lecture``.
    address : str
        Its address; without one its name, which is the same everywhere.

    Raises
    ------
    InputError
        For another name.
    """
    if name not in DOCUMENTS:
        raise unknown("schema", name, DOCUMENTS, "schema")
    return {"$schema": DIALECT, "$id": address or f"urn:combbench:schema:{name}", **_made(name)}


@cache
def _made(name: str) -> Schema:
    definitions = Definitions()
    schema = DOCUMENTS[name](definitions)
    return {"title": TITLES[name], **schema, "$defs": dict(sorted(definitions.found.items()))}

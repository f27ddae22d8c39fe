"""A lab sheet in a file, and the package that a course takes in."""

from __future__ import annotations

import io
import json
import math
import xml.etree.ElementTree as ET
import zipfile

import pytest

from core.errors import InputError
from scenarios.in_a_file.questions import file_sheet, inserted
from scenarios.in_a_file.scorm import package
from scenarios.library import get as get_scenario
from scenarios.sheets import get, ids
from scenarios.sheets.judge import judge
from scenarios.sheets.sheet import Answered

CP = "{http://www.imsproject.org/xsd/imscp_rootv1p1p2}"
ADL = "{http://www.adlnet.org/xsd/adlcp_rootv1p2}"


def test_a_package_has_a_manifest_that_leads_to_its_page():
    content = package("first-look", "Masses & springs", "<!doctype html>")
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        assert archive.namelist() == ["imsmanifest.xml", "index.html"]
        assert archive.read("index.html") == b"<!doctype html>"
        manifest = ET.fromstring(archive.read("imsmanifest.xml"))
    assert manifest.findtext(f"{CP}metadata/{CP}schemaversion") == "1.2"
    item = manifest.find(f"{CP}organizations/{CP}organization/{CP}item")
    resource = manifest.find(f"{CP}resources/{CP}resource")
    assert item is not None and resource is not None
    assert item.findtext(f"{CP}title") == "Masses & springs"
    assert item.get("identifierref") == resource.get("identifier")
    assert (resource.get("href"), resource.get(f"{ADL}scormtype")) == ("index.html", "sco")
    assert content == package("first-look", "Masses & springs", "<!doctype html>")


def test_the_numbers_of_a_sheet_are_right_for_the_bench_in_the_file():
    found = file_sheet(get("resonance-and-q"))
    asked = {one["question"]: one for one in found.document["questions"]}
    frequency = asked["What is the resonance frequency?"]
    device = found.scenario.spec.context().device  # in mg and uN/um, so that times are in ms
    assert frequency["value"] == pytest.approx(1e3 * (device.stiffness / device.mass) ** 0.5 / math.tau, rel=1e-6)
    assert file_sheet(get("resonance-and-q")).document == found.document
    step = next(one for one in get("resonance-and-q").steps if one.id == "f0")
    assert isinstance(step, Answered)
    for factor, share in ((1.0 + 0.9 * frequency["within"], 1.0), (1.04, 0.5), (1.2, 0.0)):
        text = f"{factor * frequency['value']} {frequency['unit']}"
        assert judge(step, text, {"f0_hz": frequency["value"]}).share == share


@pytest.mark.parametrize("name", ids())
def test_a_file_has_no_question_with_few_choices_and_no_hidden_fault(name: str):
    sheet = get(name)
    try:
        found = file_sheet(sheet)
    except InputError as error:
        assert "asks for no number" in str(error)
        return
    text = json.dumps(found.document)
    choices = [one.choice for one in sheet.steps if isinstance(one, Answered) and one.choice]
    for option in (option for choice in choices for option in choice.options):
        assert all(len(words) < 16 or words not in text for words in (option.text, option.because))
    left = len(sheet.steps) - len(found.document["questions"])
    assert found.document["rest"].startswith(f"{left} other step") if left else not found.document["rest"]
    library = get_scenario(sheet.head.bench.scenario)
    assert found.scenario.document.get("faults") == library.document.get("faults")
    assert found.scenario.document.get("events") in ([], library.document.get("events"))
    assert not {"mistakes", "choice", "options", "solution"} & {
        key for one in found.document["questions"] for key in one
    }


def test_a_number_that_needs_a_measurement_is_three_dots():
    assert inserted("{{ a | Hz }} and {{ later_b }}", {"a": 1500.0}) == "1.5\u00a0kHz and ..."


def test_the_words_of_a_sheet_are_without_the_marks_of_markdown():
    text = "**Goal.** You find\n*linear* $Q$.\n\n$$x=\\frac{a}\n{b}$$\n\nThen $\\omega$."
    assert inserted(text, {}) == "Goal. You find linear Q.\n\nThen $\\omega$."

"""Mathematics that is handed on: set as before, and no markup, address or style that LaTeX writes."""

from __future__ import annotations

import re
from html import unescape
from html.parser import HTMLParser

import pytest
from latex2mathml.converter import convert

from scenarios import sheets
from scenarios.report.mathml import KEPT, mathml
from scenarios.report.sheet import markdown

HOSTILE = [
    r"$\href{javascript:alert(1)}{x}$",
    r"$\href{x\" onclick=\"alert(1)}{x}$",
    r"$\style{background:url(http://elsewhere.example/)}{x}$",
    r"$\class{a}{\text{<img src=x onerror=alert(1)>}}$",
    r"$\text{<script>alert(1)</script>}$",
    r"$\text{&lt;script&gt;alert(1)&lt;/script&gt;}$",
    r"$\unicode{x3c}script\unicode{x3e}$",
    r"$$\mathrm{&#60;b&#62;}$$",
    r"[x](javascript:alert(1))",
    r"<b onclick='x'>",
]


class Parts(HTMLParser):
    """The elements of a document, and their attributes."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.names: set[str] = set()
        self.attributes: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.names.add(tag)
        self.attributes |= {name for name, _ in attrs if tag not in ("span", "div")}


@pytest.mark.parametrize("text", HOSTILE)
def test_nothing_that_latex_writes_is_markup(text: str) -> None:
    found = Parts(markdown(text))
    assert all(name in ("p", "span", "div") or re.fullmatch("m[a-z]+", name) for name in found.names), found.names
    assert found.attributes <= KEPT


def test_the_mathematics_of_all_sheets_is_set_as_the_converter_sets_it() -> None:
    formulas = [latex for name in sheets.ids() for latex in re.findall(r"\$([^$]+)\$", sheets.get(name).source)]
    assert len(formulas) > 40
    for latex in formulas:
        assert unescape(mathml(latex, is_block=False)).replace(" />", "/>") == unescape(convert(latex)).replace(
            " />", "/>"
        )


@pytest.mark.parametrize(("latex", "primes"), [("I'^2", 1), ("I''^{2}P", 2)])
def test_a_derivative_to_a_power_has_one_exponent(latex: str, primes: int) -> None:
    made = mathml(latex, is_block=False)
    exponent = "<mi>&#x02032;</mi>" * primes + "<mn>2</mn>"
    assert unescape(exponent) in re.sub(r"</?mrow>", "", made), made
    assert made.count("<msup>") == 1

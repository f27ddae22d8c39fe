"""Mathematics for a document that is handed on: MathML that browsers draw without a script or a font, and no more."""

from __future__ import annotations

import re
from html import unescape
from xml.etree.ElementTree import tostring

from latex2mathml.converter import Converter

KEPT = frozenset(
    "xmlns display displaystyle scriptlevel mathvariant mathsize mathcolor mathbackground stretchy fence form "
    "separator largeop movablelimits symmetric accent accentunder minsize maxsize lspace rspace width height depth "
    "voffset linethickness columnalign columnlines columnspacing rowalign rowlines rowspacing frame notation".split()
)
"""Attributes for the setting of mathematics; the converter also takes addresses, styles and classes from LaTeX."""
PRIMED = re.compile(r"(?<!')('+)\^(\{[^{}]*\}|[^\s\\{}])")
"""A derivative to a power, ``f'^2``, which the converter takes for two exponents."""


def mathml(latex: str, *, is_block: bool) -> str:
    """Return mathematics as MathML; LaTeX cannot insert markup of its own.

    Parameters
    ----------
    latex : str
        LaTeX from a sheet.
    is_block : bool
        Whether it has a line of its own.
    """
    latex = PRIMED.sub(lambda found: "^{" + r"\prime " * len(found[1]) + found[2] + "}", latex)
    root = Converter(display="block" if is_block else "inline").convert_to_element(latex)
    for part in root.iter():
        # the converter writes signs as references to them, which are no text of LaTeX
        part.text, part.tail = unescape(part.text or ""), unescape(part.tail or "")
        for name, value in list(part.attrib.items()):
            if name in KEPT:
                part.set(name, unescape(value))
            else:
                del part.attrib[name]
    return tostring(root, encoding="unicode")

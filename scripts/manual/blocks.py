"""Pages of the catalogue: every block with its equations, errata, parameters and signals."""

from __future__ import annotations

from collections.abc import Iterator

from core.block import LOOP
from core.cards import BlockCard, EquationCard, ParameterCard, PortCard
from core.format import unit_text
from core.registry import FAMILIES, catalog
from manual.markdown import block, code, menu, page, shown, table

TITLES = {
    "reference": "References",
    "rate": "Angular rates",
    "plant": "Plants",
    "sense": "Sensors",
    "control": "Controllers",
    "identify": "Identifiers",
    "diagnose": "Diagnosers",
    "supervise": "Supervisors",
    "readout": "Read-outs",
    "faults": "Faults",
    LOOP: "Blocks of every bench",
}
"""Headings of the families."""
READERS = "For people who write scenarios, and for readers who want the equations behind a block."
PARAMETER = ("parameter", "default", "range", "unit", "meaning")
SIGNAL = ("signal", "unit", "meaning")


def pages() -> dict[str, str]:
    """Return the pages by their address: a list, one page for each family, and the errata."""
    cards = {family: catalog(family) for family in FAMILIES}
    first = [f"## [{TITLES[family]}]({family}.md)\n\n{_list(family, cards[family])}" for family in FAMILIES]
    about = (
        "A block is a plant, a sensor, a controller, a fault, a diagnoser. `combbench catalog` prints the same entries."
    )
    written = {"reference/blocks/index": page("Blocks", READERS, [about, *first, menu(FAMILIES)])}
    for family in FAMILIES:
        parts = [part for card in cards[family] for part in _block(card)]
        written[f"reference/blocks/{family}"] = page(TITLES[family], READERS, parts)
    written["reference/errata"] = _errata([card for family in FAMILIES for card in cards[family]])
    return written


def _list(family: str, cards: list[BlockCard]) -> str:
    return "\n".join(f"- [{shown(card.title)}](#block-{family}-{card.name}): {shown(card.summary)}" for card in cards)


def _block(card: BlockCard) -> Iterator[str]:
    """Write the entry of a block."""
    yield f"(block-{card.family}-{card.name})=\n## {shown(card.title)}"
    yield f"{code(card.name)} · {shown(card.summary)}"
    if card.changes:
        yield f"Changes: {shown(card.changes)}."
    for equation in card.equations:
        yield from _equation(equation)
    if card.weaknesses:
        yield "\n".join(["Known weaknesses:", "", *(f"- {shown(weakness)}" for weakness in card.weaknesses)])
    yield table(PARAMETER, map(_parameter, card.parameters))
    for title, ports in (("Inputs", card.inputs), ("Outputs", card.outputs), ("Taps", card.taps)):
        if ports:
            yield f"**{title}**"
            yield table(SIGNAL, map(_port, ports))


def _equation(equation: EquationCard) -> Iterator[str]:
    """Write an equation with its source, and the printed one where that is wrong."""
    source = f", {shown(equation.source)}" if equation.source else ""
    yield f"*{shown(equation.label)}*{source}:"
    yield block(equation.latex)
    if equation.printed:
        yield f"Printed as {{math}}`{equation.printed}`. {shown(_sentence(equation.why or ''))}"


def _parameter(parameter: ParameterCard) -> tuple[str, ...]:
    default = "" if parameter.default is None or isinstance(parameter.default, dict | list) else code(parameter.default)
    low, high = (None if end is None else f"{end:g}" for end in (parameter.minimum, parameter.maximum))
    between = {(True, True): f"{low} to {high}", (True, False): f"from {low}", (False, True): f"to {high}"}
    limits = between.get((low is not None, high is not None), "")
    allowed = (
        ", ".join(map(code, parameter.choices)) or limits or ("" if parameter.type == "number" else parameter.type)
    )
    return code(parameter.name), default, allowed, shown(unit_text(parameter.unit)), shown(parameter.meaning)


def _port(port: PortCard) -> tuple[str, ...]:
    source = f" (from {code(port.source)})" if port.source else ""
    return code(port.name), shown(unit_text(port.unit)), shown(port.meaning) + source


def _errata(cards: list[BlockCard]) -> str:
    """Write all equations that differ from the print, each with the reason."""
    about = "Equations of the dissertation that are wrong as printed, each with the equation that the bench computes."
    parts = [about]
    for card in cards:
        wrong = [equation for equation in card.equations if equation.printed]
        if wrong:
            parts.append(f"## [{shown(card.title)}](#block-{card.family}-{card.name})")
            parts += [part for equation in wrong for part in _equation(equation)]
    return page("Errata", "For readers of the dissertation.", parts)


def _sentence(text: str) -> str:
    """Return a reason as a sentence."""
    return text[:1].upper() + text[1:].rstrip(".") + "." if text else ""

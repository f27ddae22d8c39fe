"""The words of sentences: moments, hypotheses, lists."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from core.board.library import Library
from core.board.spec import Section
from core.diagnose.hypothesis import ModelList, NamedModel
from core.errors import InputError
from core.format import MINUS, format_short, format_si

NOUNS = {"gain": "drive gain", "second_stiffness": "stiffness along y"}
"""Factors with an unclear name."""
RATIO, TIMES = "_ratio", "×\u00a0"
"""A value over the nominal value: the damping ratio of an oscillator is another quantity."""


def moment(ms: float) -> str:
    """Write a moment of device time."""
    return format_si(ms, "ms", 4)


def length(ms: float) -> str:
    """Write a stretch of device time."""
    return format_short(ms, "ms", 3)


def figure(value: float, unit: str) -> str:
    """Write a measured figure."""
    return format_si(value, unit, 3)


def change(share: float) -> str:
    """Write a share that was added, in percent with its sign."""
    text = format_short(share * 100.0, "%", 3)
    return text if text.startswith(MINUS) or share == 0.0 else f"+{text}"


def uncapital(title: str) -> str:
    """Write a title within a sentence; a title that begins with an abbreviation stays."""
    return title if title[1:2].isupper() else title[:1].lower() + title[1:]


def listed(parts: Sequence[str]) -> str:
    """Join words to a list."""
    return " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)


def hypothesis_words(model: NamedModel) -> str:
    """Say a hypothesis in words: "m+5" reads "mass +5 %"; a name that is no abbreviation stays."""
    said = model.model_dump(exclude_defaults=True, exclude={"name"})
    if not said or not any(letter.isdigit() for letter in model.name):
        return model.name
    return ", ".join(_factor(name, value) for name, value in said.items())


def diagnosis_words(diagnosers: Mapping[str, Section]) -> dict[str, str]:
    """Return the diagnosers of a bench by their titles and all hypotheses in words, each by its name."""
    words = {}
    for name, section in diagnosers.items():
        title = section.block.title
        words[name] = title if name == section.block.name else f"{title}, {name.replace('_', ' ')}"
        models = section.params.hypotheses if isinstance(section.params, ModelList) else []
        words |= {model.name: hypothesis_words(model) for model in models}
    return words


def title_of(library: Library, family: str, name: Any) -> str:
    """Return the title of a block; its name where this version does not know it."""
    try:
        return library.block(family, str(name), "").title
    except InputError:
        return str(name)


def act_words(command: Mapping[str, Any], library: Library) -> str:
    """Say an act of a supervisor: "sets LQG to mass × 1.05", "switches to PID"."""
    if "switch" in command:
        return f"switches to {title_of(library, 'control', command['switch'])}"
    if "set" not in command:
        return "sets safe outputs"
    values: dict[str, list[str]] = {}
    for path, value in command["set"].items():
        place, _, name = path.rpartition(".")
        times, shown = TIMES if name.endswith(RATIO) else "", str(value)
        if isinstance(value, float):
            shown = format_short(value, "", 4)
        values.setdefault(place, []).append(f"{name.removesuffix(RATIO).replace('_', ' ')} {times}{shown}")
    return f"sets {listed([f'{_place(place, library)} to {listed(said)}' for place, said in values.items()])}"


def reason_words(reason: str, diagnosers: Mapping[str, Section]) -> str:
    """Write the reason of an act with the hypotheses in it in words."""
    for name, words in diagnosis_words(diagnosers).items():
        reason = reason.replace(f"named {name} for", f"named {words} for")
    return reason


def _place(place: str, library: Library) -> str:
    """Say where a value belongs: a controller by its title, anything else by its path."""
    family, _, name = place.partition(".")
    return title_of(library, "control", name) if family == "controllers" else place.replace("_", " ")


def _factor(name: str, value: float) -> str:
    """Write a factor on the nominal device, or an additive change in its unit."""
    if name.endswith("_dps"):
        sign = "+" if value > 0.0 else ""
        return f"{name[:-4].replace('_', ' ')} {sign}{format_short(value, 'deg/s', 3)}"
    return f"{NOUNS.get(name, name.replace('_', ' '))} {change(value - 1.0)}"

"""Changes while a board runs: parameters by their paths, and their values now."""

from __future__ import annotations

from typing import Any

from core.board.document import CHOSEN, PARKED, SUPERVISOR, as_written
from core.board.parse import changed
from core.board.spec import Section, Spec
from core.cards import is_live
from core.errors import InputError, unknown

LIVE_SECTIONS = ("environment", "plant", "reference", "model", "drive", "board", "guard")


def live_change(spec: Spec, values: dict[str, Any]) -> tuple[Spec, dict[str, Any], dict[str, Any]]:
    """Return the bench with other values at dotted paths, then the old values and the new.

    Raises
    ------
    InputError
        For a value that is not allowed, that cannot change while the board runs, or of a part that is not there.
    """
    new = changed(spec, values)
    for path in values:
        _check_there(new, path)
    try:
        _check_live(spec, new)
    except InputError as error:
        raise as_written(error, new.document, values) from None
    return new, {path: value_at(spec, path) for path in values}, dict(values)


def _check_there(spec: Spec, path: str) -> None:
    """Refuse a parameter of a controller or a sensor that is not for this bench."""
    key, _, rest = path.partition(".")
    name = rest.partition(".")[0]
    for one, (all_of_them, _) in PARKED.items():
        if name and key == all_of_them and name not in (known := getattr(spec, key)):
            raise unknown(one, name, known, f"{key}.{name}")


def _check_live(spec: Spec, new: Spec) -> None:
    """Refuse a change that is not possible while the board runs."""
    for field in ("sample_rate_khz", "seed"):
        if getattr(new.frame, field) != getattr(spec.frame, field):
            raise _not_live(field)
    if new.library is not spec.library:
        raise _not_live("units")
    for key in LIVE_SECTIONS:
        _check_section(key, getattr(spec, key), getattr(new, key))
    if new.device != spec.device:
        raise _not_live("device")
    for key, section in new.generators.items():
        _check_section(key, spec.generators[key], section)
    for name in (*new.controllers, *new.driving.values()):
        if name not in spec.controllers:
            hint = f"there are: {', '.join(spec.controllers)}"
            raise InputError(f"{name} is not on this bench", "controller.kind", hint, "unknown")
    for key in ("controllers", "sensors"):
        before = getattr(spec, key)
        for name, section in getattr(new, key).items():
            _check_section(f"{key}.{name}", before[name], section)
    if list(new.supervisors) != list(spec.supervisors):
        raise _not_live(SUPERVISOR)
    for key, section in new.supervisors.items():
        _check_section(key, spec.supervisors[key], section)
    for key in CHOSEN:
        before, after = getattr(spec, key), getattr(new, key)
        if list(after) != list(before):
            raise _not_live(key)
        for name, section in after.items():
            _check_section(f"{key}.{name}", before[name], section)


def _check_section(path: str, old: Section, new: Section) -> None:
    if old is new:
        return
    if old.every != new.every:
        raise _not_live(f"{path}.every")
    if old.block is not new.block:
        ports = [(port.name, port.labels) for port in (*old.block.outputs, *old.block.taps)]
        if path.startswith((*CHOSEN, SUPERVISOR)) or ports != [
            (p.name, p.labels) for p in (*new.block.outputs, *new.block.taps)
        ]:
            raise _not_live(f"{path}.kind")
        return
    for name, info in type(new.params).model_fields.items():
        if getattr(old.params, name) != getattr(new.params, name) and not is_live(info):
            raise _not_live(f"{path}.{name}")


def _not_live(path: str) -> InputError:
    return InputError("cannot change while the board runs", path, "reset the bench with the new value", "not_live")


def value_at(spec: Spec, path: str) -> Any:
    """Return the value a path has now, defaults included."""
    head, _, leaf = path.rpartition(".")
    in_use = {"controller.kind": spec.active, "sensor.kind": spec.measuring}
    in_use |= {f"slots.{slot}": name for slot, name in spec.driving.items()}
    if path in in_use:
        return in_use[path]
    section = section_at(spec, head)
    if section is None:
        return None
    return section.block.name if leaf in ("kind", "model") else getattr(section.params, leaf, None)


def section_at(spec: Spec, head: str) -> Section | None:
    """Return the section that a path leads to, such as ``controller`` or ``sensors.ideal``."""
    sections: dict[str, Section] = {key: getattr(spec, key) for key in LIVE_SECTIONS}
    for key in ("controllers", "sensors", *CHOSEN):
        sections |= {f"{key}.{name}": section for name, section in getattr(spec, key).items()}
    sections |= {**spec.generators, **spec.supervisors}
    sections["controller"] = spec.controllers[spec.active]
    sections["sensor"] = spec.sensors[spec.measuring]
    return sections.get(head)

"""Computations other than the run of a board; each file holds one, and its name is the kind in ``study``."""

from __future__ import annotations

import importlib
import pkgutil
from functools import cache
from typing import Any

from pydantic import ValidationError

from core.block import BlockParams
from core.errors import InputError, from_validation, unknown
from scenarios.studies.study import Study


@cache
def studies() -> dict[str, type[Study]]:
    """Return every study by name."""
    kinds: dict[str, type[Study]] = {}
    for module_info in pkgutil.iter_modules(__path__):
        module = importlib.import_module(f"{__name__}.{module_info.name}")
        for value in vars(module).values():
            if isinstance(value, type) and issubclass(value, Study) and value.__module__ == module.__name__:
                kinds[module_info.name] = value
    del kinds["study"]
    return kinds


def parse_study(table: dict[str, Any]) -> tuple[type[Study], BlockParams]:
    """Return the study of a table, with its parameters.

    Raises
    ------
    InputError
        For an unknown kind, field or value, below ``study``.
    """
    rest = dict(table)
    kind = rest.pop("kind", None)
    if not isinstance(kind, str) or kind not in studies():
        raise unknown("study", kind, studies(), "study.kind")
    study = studies()[kind]
    try:
        return study, study.Params.model_validate(rest)
    except ValidationError as error:
        raise from_validation(error, {"": list(study.Params.model_fields)}).under("study") from None
    except InputError as error:
        raise error.under("study") from None

"""Names of signals as MATLAB takes them: for variables and fields."""

from __future__ import annotations

import re
from collections.abc import Sequence

LONGEST = 63
"""Characters of a name that MATLAB keeps (``namelengthmax``)."""
KEYWORDS = frozenset(
    "break case catch classdef continue else elseif end for function global if otherwise parfor persistent return "
    "spmd switch try while".split()
)
"""Words that are no names (``iskeyword``)."""
SPOKEN = {"+": "_plus_", "-": "_minus_"}


def variables(names: Sequence[str], taken: Sequence[str] = ()) -> dict[str, str]:
    """Return a variable for each name: letters, digits and underscores, each once.

    A dot becomes an underscore, as does any other character that MATLAB refuses; names that differ in nothing else get
    a number.

    Parameters
    ----------
    names : sequence of str
        Names of signals, each once.
    taken : sequence of str
        Further variables of the file.
    """
    found: dict[str, str] = {}
    used = set(taken)
    for name in names:
        plain = re.sub(r"[^A-Za-z0-9_]", "_", re.sub("[+-]", lambda sign: SPOKEN[sign[0]], name))
        plain = plain if re.match("[A-Za-z]", plain) and plain not in KEYWORDS else f"x_{plain}"
        variable, number = plain[:LONGEST], 1
        while variable in used:
            number += 1
            variable = plain[: LONGEST - len(f"_{number}")] + f"_{number}"
        used.add(variable)
        found[name] = variable
    return found

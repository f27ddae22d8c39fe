"""Scores of the diagnosers of a board."""

from __future__ import annotations

from core.board.instances import scored
from core.board.spec import Spec
from core.board.wiring import Wiring
from core.diagnose.hypothesis import names_of
from core.loop import score


def scores(spec: Spec, wiring: Wiring) -> dict[str, score.Scores]:
    """Return the score of every diagnoser that chooses between hypotheses; none on a record without labels."""
    if spec.record is not None and not spec.record.has_labels:
        return {}
    found = {}
    for name, section in spec.diagnosers.items():
        if scored(section.block):
            winner, unexplained = (wiring.w[wiring.index[f"{name}.{port}"]] for port in ("winner", "unexplained"))
            state, names = wiring.state(f"{name}.score"), names_of(section.params)
            found[name] = score.read(state, names, int(winner), bool(unexplained != 0.0))
    return found

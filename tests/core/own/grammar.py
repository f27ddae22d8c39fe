"""Random steps from the grammar of the notation, right and nearly right, from a seed."""

from __future__ import annotations

from random import Random

from tests.core.own.texts import odd

NUMBERS = ("0.0", "1.0", "-1.0", "0.5", "3", "-2", "1e-3", "1e30", "1e-300")
READ = (
    "e",
    "x.measured",
    "x.model",
    "x.reference",
    "x.applied",
    "x.tick",
    "x.time_ms",
    "p.gain",
    "p.dt_ms",
    "s.a",
    "x.seen",
)
FUNCTIONS = (("exp", 1), ("sin", 1), ("floor", 1), ("flush_tiny", 1), ("abs", 1), ("min", 2), ("max", 2), ("mix", 2))
WRITTEN = ("s.a", "x.seen", "s.line[0]", "s.line[4]", "s.grid[3]", "x.three[1]", "x.measured", "s.line[5]", "p.gain")
VECTORS = {"s.line": 5, "s.grid": 12, "p.taps": 4, "x.three": 3}
EFFECTS = ("bump(s)", "turn(s, x)", "stir(s.line, s.a)", "stir(x.three, e)")
HELPERS = """@kernel
def mix(a, b):
    if a > b:
        return a - b
    return 0.25 * a + b

def bump(r):
    r.a += 1.0
    return r.a

@kernel
def stir(line, by):
    line[int(by)] -= by
    line[int(line[0])], line[1] = line[1], line[int(by)]
    return line[2]

def turn(r, y):
    r.line[int(bump(r))] += bump(r)
    y.seen = mix(bump(r), r.line[int(r.a)])
    return stir(r.grid, r.a) + bump(r)"""
"""Functions of the unit: one that only computes, and others that also write their arguments."""


class Writer:
    """Writes steps.

    Parameters
    ----------
    seed : int
        The same seed writes the same step.
    """

    def __init__(self, seed: int) -> None:
        self._random = Random(seed)
        self._names = ["e"]
        self._counters: list[tuple[str, int]] = []
        self._made = 0
        self._is_careless = self._random.random() < 0.4

    def text(self) -> str:
        """Return the text of a unit."""
        return odd("step", "\n".join(self._body(self._random.randint(2, 7), 0)), top=HELPERS)

    def _pick(self, *several: str) -> str:
        return self._random.choice(several)

    def _number(self, deep: int = 0) -> str:
        chance = self._random.random()
        if chance < 0.08:
            return self._pick(*EFFECTS)
        if deep > 3 or chance < 0.25:
            return self._pick(*NUMBERS, *self._names, *READ)
        if chance < 0.55:
            return f"({self._number(deep + 1)} {self._pick('+', '-', '*', '/')} {self._number(deep + 1)})"
        if chance < 0.7:
            name, count = self._random.choice(FUNCTIONS)
            return f"{name}({', '.join(self._number(deep + 1) for _ in range(count))})"
        if chance < 0.8:
            return f"({self._number(deep + 1)} if {self._condition(deep + 1)} else {self._number(deep + 1)})"
        if chance < 0.95:
            return self._item(*VECTORS)
        if not self._is_careless:
            return self._pick(*self._names)
        return self._pick("(e ** 2)", "e.real", "undeclared", "x.nothing", "s.line", "(e > 0.0)", "(e, e)")

    def _item(self, *vectors: str) -> str:
        """Return an item of a vector; the careful know how many there are."""
        name = self._pick(*vectors)
        count = VECTORS[name]
        fitting = [counter for counter, rounds in self._counters if rounds <= count]
        choices = [str(self._random.randrange(count)), f"int({self._number(3)})"]
        choices += fitting * 2 + [f"{counter} % 3" for counter, _ in self._counters]
        choices += [f"{count - 1} - {counter}" for counter in fitting]
        if self._is_careless:
            choices += [str(count), "-1", *(f"{counter} + 1" for counter, _ in self._counters)]
        return f"{name}[{self._pick(*choices)}]"

    def _condition(self, deep: int) -> str:
        chance = self._random.random()
        if deep > 3 or chance < 0.7:
            return f"{self._number(deep + 1)} {self._pick('<', '<=', '>', '>=', '==', '!=')} {self._number(deep + 1)}"
        if chance < 0.95:
            return f"({self._condition(deep + 1)} {self._pick('and', 'or')} not {self._condition(deep + 1)})"
        return self._pick("e", "1.0", "True") if self._is_careless else "True"

    def _body(self, count: int, deep: int) -> list[str]:
        return [line for _ in range(count) for line in self._statement(deep)]

    def _statement(self, deep: int) -> list[str]:
        chance = self._random.random()
        if chance < 0.35:
            self._made += 1
            name = f"{self._pick('v', 'mix_', 'bump_')}{self._made - 1}"
            line = f"{name} = {self._number()}"
            if deep == 0:
                self._names.append(name)
            return [line]
        if chance < 0.7 or deep > 2:
            target = self._pick(*WRITTEN[:6], *(WRITTEN if self._is_careless else ()))
            if self._random.random() < 0.4:
                target = self._item("s.line", "s.grid", "x.three")
            return [f"{target} {self._pick('=', '=', '+=', '-=', '*=')} {self._number()}"]
        if chance < 0.85:
            inner = self._body(self._random.randint(1, 2), deep + 1)
            other = self._body(1, deep + 1) if self._random.random() < 0.5 else []
            lines = [f"if {self._condition(0)}:", *(f"    {line}" for line in inner)]
            return lines + (["else:", *(f"    {line}" for line in other)] if other else [])
        self._made += 1
        name, rounds = f"i{self._made}", self._random.choice((2, 3, 5, 9))
        self._counters.append((name, rounds))
        inner = self._body(self._random.randint(1, 2), deep + 1)
        self._counters.pop()
        return [f"for {name} in range({rounds}):", *(f"    {line}" for line in inner)]

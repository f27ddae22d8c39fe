"""Seeds of the benchmark: 128 bits for each case, in lists that anyone can work out, and one hidden list."""

from __future__ import annotations

import hashlib
import secrets
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from pydantic import StringConstraints, ValidationError

from core.errors import InputError, from_validation
from core.nesting import read_toml
from core.table import Table

BENCHMARK = "mems-diag-1"
SEED_BYTES, SALT_BYTES = 16, 32
COMMITMENT = "1a1c59d3199ea7a0fe191b7578b036b4770669f3cff4f36711ed19e3a52eef75"
"""SHA-256 of the hidden list, published before the first measurement with it."""
CASES, CALIBRATIONS = "cases", "calibration"


@dataclass(frozen=True)
class SeedList:
    """A list of seeds.

    Attributes
    ----------
    name : str
        Name of the list.
    cases : mapping
        The seeds of the cases of each track.
    calibrations : int
        Healthy runs of each track for setting thresholds; their seeds are never seeds of cases.
    """

    name: str
    cases: Mapping[str, tuple[str, ...]]
    calibrations: int

    def calibration(self, track: str) -> tuple[str, ...]:
        """Return the seeds of the healthy runs of a track."""
        return derived(CALIBRATIONS, track, self.calibrations)


def derived(name: str, track: str, count: int) -> tuple[str, ...]:
    r"""Return seeds by a fixed rule, :math:`\text{SHA-256}(\text{benchmark name track number})`, 128 bits."""
    texts = (f"{BENCHMARK} {name} {track} {number}" for number in range(1, count + 1))
    return tuple(hashlib.sha256(text.encode()).digest()[:SEED_BYTES].hex() for text in texts)


LISTS = {"public": (100, 200), "demonstration": (3, 4)}
"""Cases and healthy runs of each track, by the name of the list."""


def seed_list(name: str, tracks: tuple[str, ...]) -> SeedList:
    """Return a list that anyone can work out."""
    cases, calibrations = LISTS[name]
    return SeedList(name, {track: derived(f"{name} {CASES}", track, cases) for track in tracks}, calibrations)


Seed = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{32}$")]
Salt = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{64}$")]


class SecretSeeds(Table):
    """A list of seeds that is secret until it is revealed, and a salt that makes it impossible to guess."""

    salt: Salt
    cases: dict[str, list[Seed]]

    def commitment(self) -> str:
        r"""Return the hash by which the list is committed, :math:`\text{SHA-256}(\text{salt}\,\Vert\,\text{seeds})`.

        Tracks come in the order of their names, each as its name, a line end and its seeds.
        """
        digest = hashlib.sha256(bytes.fromhex(self.salt))
        for track in sorted(self.cases):
            digest.update(f"{track}\n".encode())
            digest.update(bytes.fromhex("".join(self.cases[track])))
        return digest.hexdigest()


def hidden_of(salt: str, tracks: tuple[str, ...]) -> SecretSeeds:
    r"""Return the list of a salt, of 128 bits each of :math:`\text{SHA-256}(\text{salt track number})`."""
    count, _ = LISTS["public"]

    def seed(track: str, number: int) -> str:
        return hashlib.sha256(f"{salt} {track} {number}".encode()).digest()[:SEED_BYTES].hex()

    return SecretSeeds(salt=salt, cases={track: [seed(track, 1 + i) for i in range(count)] for track in tracks})


def hidden_list(text: str, tracks: tuple[str, ...]) -> SeedList:
    """Read a hidden list and verify it.

    Raises
    ------
    InputError
        When it is malformed, lacks a track, or is not the list that was committed.
    """
    try:
        hidden = SecretSeeds.model_validate(read_toml(text, "--seeds"))
    except ValidationError as error:
        raise from_validation(error, {"": [*SecretSeeds.model_fields]}).under("--seeds") from None
    if {*hidden.cases} != {*tracks}:
        raise InputError(f"needs seeds for each track and no other: {', '.join(tracks)}", "--seeds")
    if (found := hidden.commitment()) != COMMITMENT:
        raise InputError(f"is not the list that was committed: {found[:16]} instead of {COMMITMENT[:16]}", "--seeds")
    return SeedList("hidden", {track: tuple(seeds) for track, seeds in hidden.cases.items()}, LISTS["public"][1])


def main() -> None:
    """Print a new hidden list, or the list of a salt: ``python -m scenarios.benchmark.seeds [SALT] > hidden.toml``."""
    import tomlkit

    from scenarios.benchmark.track import tracks

    salt = sys.argv[1] if len(sys.argv) > 1 else secrets.token_hex(SALT_BYTES)
    hidden = hidden_of(salt, tuple(tracks()))
    sys.stdout.write(tomlkit.dumps(hidden.model_dump()))
    sys.stderr.write(f"commitment: {hidden.commitment()}\n")


if __name__ == "__main__":
    main()

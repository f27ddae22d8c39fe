r"""Noise as a pure function of (seed, stream, tick).

A 64-bit counter is hashed (the finaliser of SplitMix64, Steele, Lea and Flood 2014, applied twice under a
key) into a uniform number, which the inverse of the normal distribution (Wichura, algorithm AS 241, 1988)
turns into a normal one. Nothing depends on which other blocks run: twins share it and forks keep it.
"""

from __future__ import annotations

import hashlib
import math

import numpy as np

from core.elementary import log
from core.kernel import kernel

GOLDEN = np.uint64(0x9E3779B97F4A7C15)
MULTIPLIER_1 = np.uint64(0xBF58476D1CE4E5B9)
MULTIPLIER_2 = np.uint64(0x94D049BB133111EB)
S30, S27, S31, S11 = np.uint64(30), np.uint64(27), np.uint64(31), np.uint64(11)
TWO_POW_MINUS_53 = 1.1102230246251565e-16


def key(seed: int, stream: str) -> float:
    """Return the key of one stream under one seed: 53 bits, so that it can be packed as a parameter."""
    digest = hashlib.blake2b(f"{seed}/{stream}".encode(), digest_size=8).digest()
    return float(int.from_bytes(digest, "little") >> 11)


@kernel
def mix(z: np.uint64) -> np.uint64:
    """Spread the bits of a 64-bit word (SplitMix64 finaliser)."""
    z = (z ^ (z >> S30)) * MULTIPLIER_1
    z = (z ^ (z >> S27)) * MULTIPLIER_2
    return z ^ (z >> S31)


@kernel
def uniform(key: float, tick: float) -> float:
    """Return a uniform number in (0, 1) for a tick below 2^53."""
    spread = np.uint64(key) * GOLDEN
    z = mix(mix(np.uint64(tick) * GOLDEN + spread) ^ spread)
    return (np.float64(z >> S11) + 0.5) * TWO_POW_MINUS_53


@kernel
def normal(key: float, tick: float) -> float:
    """Return a standard normal number (AS 241, relative accuracy about 1e-16)."""
    q = uniform(key, tick) - 0.5
    if abs(q) <= 0.425:
        r = 0.180625 - q * q
        num = 2.5090809287301226727e3
        num = num * r + 3.3430575583588128105e4
        num = num * r + 6.7265770927008700853e4
        num = num * r + 4.5921953931549871457e4
        num = num * r + 1.3731693765509461125e4
        num = num * r + 1.9715909503065514427e3
        num = num * r + 1.3314166789178437745e2
        num = num * r + 3.3871328727963666080
        den = 5.2264952788528545610e3
        den = den * r + 2.8729085735721942674e4
        den = den * r + 3.9307895800092710610e4
        den = den * r + 2.1213794301586595867e4
        den = den * r + 5.3941960214247511077e3
        den = den * r + 6.8718700749205790830e2
        den = den * r + 4.2313330701600911252e1
        den = den * r + 1.0
        return q * num / den
    r = 0.5 + q if q < 0.0 else 0.5 - q
    r = math.sqrt(-log(r))
    if r <= 5.0:
        r -= 1.6
        num = 7.74545014278341407640e-4
        num = num * r + 2.27238449892691845833e-2
        num = num * r + 2.41780725177450611770e-1
        num = num * r + 1.27045825245236838258
        num = num * r + 3.64784832476320460504
        num = num * r + 5.76949722146069140550
        num = num * r + 4.63033784615654529590
        num = num * r + 1.42343711074968357734
        den = 1.05075007164441684324e-9
        den = den * r + 5.47593808499534494600e-4
        den = den * r + 1.51986665636164571966e-2
        den = den * r + 1.48103976427480074590e-1
        den = den * r + 6.89767334985100004550e-1
        den = den * r + 1.67638483018380384940
        den = den * r + 2.05319162663775882187
        den = den * r + 1.0
    else:
        r -= 5.0
        num = 2.01033439929228813265e-7
        num = num * r + 2.71155556874348757815e-5
        num = num * r + 1.24266094738807843860e-3
        num = num * r + 2.65321895265761230930e-2
        num = num * r + 2.96560571828504891230e-1
        num = num * r + 1.78482653991729133580
        num = num * r + 5.46378491116411436990
        num = num * r + 6.65790464350110377720
        den = 2.04426310338993978564e-15
        den = den * r + 1.42151175831644588870e-7
        den = den * r + 1.84631831751005468180e-5
        den = den * r + 7.86869131145613259100e-4
        den = den * r + 1.48753612908506148525e-2
        den = den * r + 1.36929880922735805310e-1
        den = den * r + 5.99832206555887937690e-1
        den = den * r + 1.0
    z = num / den
    return -z if q < 0.0 else z

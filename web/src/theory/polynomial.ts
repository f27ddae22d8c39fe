import { formatShort, inTex } from "../ui/format";
import { roundTo } from "../ui/unit-scale";

/** Coefficients, lowest power first. */
export type Polynomial = readonly number[];

function trimmed(p: Polynomial): Polynomial {
  let length = p.length;
  while (length > 1 && p[length - 1] === 0) length -= 1;
  return p.slice(0, length);
}

export function add(a: Polynomial, b: Polynomial, sign = 1): Polynomial {
  return trimmed(Array.from({ length: Math.max(a.length, b.length) }, (_, i) => (a[i] ?? 0) + sign * (b[i] ?? 0)));
}

export function multiply(a: Polynomial, b: Polynomial): Polynomial {
  const found = new Array<number>(a.length + b.length - 1).fill(0);
  a.forEach((x, i) => {
    b.forEach((y, j) => {
      found[i + j] += x * y;
    });
  });
  return trimmed(found);
}

export const isZero = (p: Polynomial): boolean => p.every((x) => x === 0);

/** A polynomial in s as LaTeX. */
export function polynomialLatex(p: Polynomial): string {
  const terms = p.flatMap((value, power) => {
    if (value === 0) return [];
    const size = roundTo(Math.abs(value), 6);
    const number = size === 1 && power > 0 ? "" : inTex(formatShort(size, "", 6));
    const s = power === 0 ? "" : power === 1 ? "s" : `s^{${power}}`;
    return [{ sign: value < 0 ? "-" : "+", text: `${number}${s}` }];
  });
  if (terms.length === 0) return "0";
  return terms
    .reverse()
    .map(({ sign, text }, i) => (i === 0 ? (sign === "-" ? `-${text}` : text) : `${sign}${text}`))
    .join("");
}

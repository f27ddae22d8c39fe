import { add, isZero, multiply, type Polynomial, polynomialLatex } from "./polynomial";

/** A ratio of polynomials in s. */
interface TransferFunction {
  numerator: Polynomial;
  denominator: Polynomial;
}

const MOST_POWER = 20;
const ONE: Polynomial = [1];
const TOKEN = /\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?)|([sSpP])|([-+*/^()]))/y;

/** The error in a typed transfer function. */
export class NotRational extends Error {}

/**
 * Read a transfer function as people write it: numbers, s, + - * / ^ and brackets; a product needs no sign.
 *
 * Nothing is cancelled: (s+1)/(s+1) keeps its pole and its zero.
 */
export function parseTransferFunction(text: string): TransferFunction {
  const tokens = tokenise(text);
  let at = 0;
  const peek = () => tokens[at];

  function sum(): TransferFunction {
    let left = product();
    while (peek() === "+" || peek() === "-") {
      const sign = tokens[at++] === "+" ? 1 : -1;
      const right = product();
      left = {
        numerator: add(multiply(left.numerator, right.denominator), multiply(right.numerator, left.denominator), sign),
        denominator: multiply(left.denominator, right.denominator),
      };
    }
    return left;
  }

  function product(): TransferFunction {
    let left = signed();
    for (;;) {
      const next = peek();
      if (next === "*" || next === "/") {
        at += 1;
        const right = signed();
        left = next === "*" ? times(left, right) : times(left, inverse(right));
      } else if (next !== undefined && (next === "(" || /[\d.s]/.test(next[0]))) left = times(left, power());
      else return left;
    }
  }

  function signed(): TransferFunction {
    if (peek() !== "-" && peek() !== "+") return power();
    const negative = tokens[at++] === "-";
    const value = signed();
    return negative ? times({ numerator: [-1], denominator: ONE }, value) : value;
  }

  function power(): TransferFunction {
    const base = atom();
    if (peek() !== "^") return base;
    at += 1;
    const exponent = Number(tokens[at++]);
    if (!Number.isInteger(exponent) || exponent < 0 || exponent > MOST_POWER)
      throw new NotRational(`a power must be a whole number from 0 to ${MOST_POWER}`);
    let found: TransferFunction = { numerator: ONE, denominator: ONE };
    for (let i = 0; i < exponent; i += 1) found = times(found, base);
    return found;
  }

  function atom(): TransferFunction {
    const token = tokens[at++];
    if (token === undefined) throw new NotRational("it ends too early");
    if (token === "s") return { numerator: [0, 1], denominator: ONE };
    if (token === "(") {
      const inside = sum();
      if (tokens[at++] !== ")") throw new NotRational("a bracket is not closed");
      return inside;
    }
    const value = Number(token);
    if (!Number.isFinite(value)) throw new NotRational(`${token} is not expected here`);
    return { numerator: [value], denominator: ONE };
  }

  const found = sum();
  if (at < tokens.length) throw new NotRational(`${tokens[at]} is not expected here`);
  if (isZero(found.numerator)) throw new NotRational("it is zero");
  return found;
}

function tokenise(text: string): string[] {
  const tokens: string[] = [];
  TOKEN.lastIndex = 0;
  const rest = text.trimEnd();
  while (TOKEN.lastIndex < rest.length) {
    const from = TOKEN.lastIndex;
    const match = TOKEN.exec(rest);
    if (!match) throw new NotRational(`${rest.slice(from).trim()[0]} is not understood`);
    tokens.push(match[2] ? "s" : (match[1] ?? match[3]));
  }
  if (tokens.length === 0) throw new NotRational("nothing is there yet");
  return tokens;
}

const times = (a: TransferFunction, b: TransferFunction): TransferFunction => ({
  numerator: multiply(a.numerator, b.numerator),
  denominator: multiply(a.denominator, b.denominator),
});

function inverse({ numerator, denominator }: TransferFunction): TransferFunction {
  if (isZero(numerator)) throw new NotRational("it divides by zero");
  return { numerator: denominator, denominator: numerator };
}

export function transferLatex({ numerator, denominator }: TransferFunction): string {
  const below = polynomialLatex(denominator);
  return below === "1" ? `G(s)=${polynomialLatex(numerator)}` : `G(s)=\\frac{${polynomialLatex(numerator)}}{${below}}`;
}

/** Coefficients as the server takes them: highest power first. */
export const highestFirst = (p: Polynomial): number[] => [...p].reverse();

import { describe, expect, it } from "vitest";
import cases from "../testing/cases/format.json";
import {
  formatBeside,
  formatChange,
  formatClock,
  formatCount,
  formatEntry,
  formatFigure,
  formatIn,
  formatMoment,
  formatNumber,
  formatOn,
  formatPercent,
  formatShort,
  formatSi,
  formatSpread,
  formatTick,
  inTex,
  keepUnits,
  labelsOn,
  tickLabels,
} from "./format";
import { plainScale, UNITS, unitScale, unitText } from "./unit-scale";

const FORMATS = { si: formatSi, short: formatShort, in: formatIn };

describe.each(Object.entries(FORMATS))("the cases it shares with Python, %s", (name, format) => {
  it.each(
    cases[name as keyof typeof cases] as [number, string, number, string][],
  )("%s %s in %s digits is %s", (...one) => {
    const [value, unit, digits, text] = one;
    expect(format(value, unit, digits)).toBe(text);
  });
});

it("has the units that Python has, and writes each as itself", () => {
  expect(Object.keys(UNITS).sort()).toEqual(Object.keys(cases.units).sort());
  for (const [unit, text] of Object.entries(cases.units)) expect(formatShort(1, unit)).toBe(text);
});

it.each(cases.percent as [number, number, string][])("writes the share %s in %s decimals as %s", (...one) => {
  const [share, decimals, text] = one;
  expect(formatPercent(share, decimals)).toBe(text);
});

it.each(cases.figure as [string, number | null, number, string][])("writes %s of %s in %s digits as %s", (...one) => {
  const [metric, value, digits, text] = one;
  expect(formatFigure(metric, value, digits)).toBe(text);
});

it.each(cases.spread as [string, number, number, string][])("writes the spread of %s, %s and %s, as %s", (...one) => {
  const [metric, mean, std, text] = one;
  expect(formatSpread(metric, mean, std)).toBe(text);
});

it.each(
  cases.spreadWithUnit as [string, number, number, string, string][],
)("writes %s, %s and %s, in %s as %s", (...one) => {
  const [metric, mean, std, unit, text] = one;
  expect(formatSpread(metric, mean, std, unit)).toBe(text);
});

it.each(
  cases.withUnit as [string, number | null, number, string, string][],
)("writes %s of %s in %s digits, in %s, as %s", (...one) => {
  const [metric, value, digits, unit, text] = one;
  expect(formatFigure(metric, value, digits, unit)).toBe(text);
});

it("gives a value and its deviation one power, one unit, and no place for a line to break", () => {
  for (const value of values(1000))
    for (const unit of ["um", "N s/m", "deg", ""]) {
      const [mean, std] = [value, Math.abs(value) / 700];
      const text = formatSpread("", mean, std, unit);
      expect(text).not.toMatch(/[ \u2009]|\de/);
      expect(text.match(/×10/g)?.length ?? 0, text).toBeLessThanOrEqual(1);
      const [shown, spread] = text.split("±").map((part) => /[\d\u202f]+(?:\.(\d+))?/.exec(part));
      expect(shown?.[1]?.length, text).toBe(spread?.[1]?.length);
    }
});

it.each(cases.beside as [number, number, number, string][])("writes %s beside %s in %s digits as %s", (...one) => {
  const [value, figure, digits, text] = one;
  expect(formatBeside(value, figure, digits)).toBe(text);
});

it.each(cases.plain as [string, number[], number, string][])("shows %s of %s by the factor %s in %s", (...one) => {
  const [unit, sizes, factor, text] = one;
  const scale = plainScale(unit, sizes);
  expect([scale.factor / factor, scale.unit]).toEqual([expect.closeTo(1, 12), text]);
});

it.each(Object.entries(cases.text))("writes the unit %s as %s", (unit, text) => expect(unitText(unit)).toBe(text));

it.each(cases.ticks as [number[], string[]][])("labels ticks as Python does, %s", (ticks, texts) =>
  expect(tickLabels(ticks)).toEqual(texts));

/** Numbers of every size and both signs, the same each time. */
function* values(count: number): Generator<number> {
  let state = 1;
  const uniform = () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
  for (let i = 0; i < count; i += 1) yield (uniform() < 0.5 ? -1 : 1) * (0.1 + uniform()) * 10 ** (60 * uniform() - 30);
}

const PREFIX = { T: 1e12, G: 1e9, M: 1e6, k: 1e3, "": 1, m: 1e-3, µ: 1e-6, n: 1e-9, p: 1e-12, f: 1e-15, a: 1e-18 };
const SHOWN = /^(−?)(\d{1,3}(?:\.\d+)?)(?:×10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?\u00a0([TGMkmµnpfa]?)V$/;

const lowered = (power: string) =>
  [...power].map((one) => (one === "⁻" ? "-" : "⁰¹²³⁴⁵⁶⁷⁸⁹".includes(one) ? "⁰¹²³⁴⁵⁶⁷⁸⁹".indexOf(one) : one)).join("");

function parsed(text: string): number {
  const [, sign, digits, power, prefix] = SHOWN.exec(text) ?? [];
  expect(digits, text).toBeDefined();
  const size = Number(digits) * 10 ** Number(lowered(power ?? "0")) * PREFIX[prefix as keyof typeof PREFIX];
  return sign ? -size : size;
}

describe.each([2, 3, 4, 6])("any value in %i digits", (digits) => {
  const half = 0.5 * 10 ** (1 - digits) * 1.000001;

  it("reads back within half of its last digit, below 1000 of its unit", () => {
    for (const value of values(3000))
      for (const format of [formatSi, formatShort]) {
        const text = format(value, "V", digits);
        expect(Math.abs(parsed(text) / value - 1), `${value} as ${text}`).toBeLessThan(half);
        expect(
          Math.abs(
            Number(
              text
                .slice(0, -1)
                .replace("−", "-")
                .match(/^-?[\d.]+/)?.[0],
            ),
          ),
          text,
        ).toBeLessThan(1000);
      }
  });

  it("shows all the digits of what is measured, and no trailing zeros of a fraction of what was chosen", () => {
    for (const value of values(1000)) {
      const [whole, fraction = ""] = (/[\d.]+/.exec(formatSi(value, "V", digits)) ?? [""])[0].split(".");
      expect(fraction.length).toBe(Math.max(0, digits - whole.length));
      expect(formatShort(value, "V", digits)).not.toMatch(/\.\d*0(\u00a0|×)/);
    }
  });

  it("keeps every whole number whole", () => {
    for (let whole = 0; whole < 1000; whole += 1) expect(formatShort(whole, "V", 3)).toBe(`${whole}\u00a0V`);
  });
});

it("says missing and boundless values by a dash", () => {
  for (const value of [Number.NaN, Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY])
    expect([formatSi(value, "V"), formatShort(value, "V"), formatIn(value, "V", 1), formatPercent(value)]).toEqual(
      Array(4).fill("–"),
    );
});

describe("formatOn", () => {
  it("keeps unit and decimals of the axis, so a value through zero does not jump", () => {
    const scale = unitScale("um", 4.1);
    expect([4.1, 0.003, -0.003, 0, -0].map((v) => formatOn(scale, v))).toEqual(
      ["4.100", "0.003", "−0.003", "0.000", "0.000"].map((text) => `${text}\u00a0µm`),
    );
  });

  it("keeps the power of ten too", () =>
    expect([2e-5, 0].map((v) => formatOn(unitScale("", 2e-5), v))).toEqual(["20.00×10⁻⁶", "0.00×10⁻⁶"]));
});

it("labels an axis whose title says the unit", () =>
  expect(labelsOn(unitScale("ms", 0.4), [0, 0.2, 0.4])).toEqual(["0", "200", "400"]));

it("shows device time to the microsecond", () => {
  expect(formatClock(184.32)).toBe("0.184\u202f320");
  expect(formatClock(12345678.901)).toBe("12\u202f345.678\u202f901");
  expect(formatMoment(1234.56)).toBe("1234.560\u00a0ms");
  expect(formatTick(1234567)).toBe("tick\u00a01\u202f234\u202f567");
});

it("counts one and many", () => {
  expect([0, 1, 2, 4096, 12345].map((n) => formatCount(n, "sample"))).toEqual([
    "0\u00a0samples",
    "1\u00a0sample",
    "2\u00a0samples",
    "4096\u00a0samples",
    "12\u202f345\u00a0samples",
  ]);
});

it("gives a change its sign, and none to what is no change", () => {
  expect([3.24, -3.24, 0.001, -0.001].map((c) => formatChange(c, "%", 1))).toEqual(
    ["+3.2", "−3.2", "0.0", "0.0"].map((text) => `${text}\u00a0%`),
  );
});

it("writes entries as they are typed", () => {
  expect([0, 0.1 + 0.2, -20, 0.001, 1.95e-6, 1e-9].map(formatEntry)).toEqual([
    "0",
    "0.3",
    "-20",
    "0.001",
    "1.95e-6",
    "1e-9",
  ]);
});

it("goes into an equation", () => {
  expect([formatSi(-2.5e-7, ""), formatNumber(123456, 0)].map(inTex)).toEqual(["-250.0\\cdot10^{-9}", "123\\,456"]);
});

it("says 0 and 100 % of nothing else, however close", () => {
  const wrong: string[] = [];
  for (const value of values(1000)) {
    const share = Math.abs(value) < 1 ? Math.abs(value) : 1 - 1 / (1 + Math.abs(value));
    if (share === 1) continue;
    for (const decimals of [0, 1, 2]) {
      const text = formatPercent(share, decimals);
      const [, bound, digits] = /^([<>]\u00a0)?([\d.]+)\u00a0%$/.exec(text) ?? [];
      const shown = Number(digits);
      const holds = bound?.startsWith("<")
        ? share * 100 < shown
        : bound
          ? share * 100 > shown
          : Math.abs(shown - share * 100) <= 0.5001 * 10 ** -decimals;
      if (!(shown > 0 && shown < 100 && holds)) wrong.push(`${share} as ${text}`);
    }
  }
  expect(wrong).toEqual([]);
});

it.each([
  ["with 5 % more mass and 80 % more stiffness", "with 5\u00a0% more mass and 80\u00a0% more stiffness"],
  ["1.751 at 1 krad/s, 0.145 um after 2 ms", "1.751 at 1\u00a0krad/s, 0.145\u00a0um after 2\u00a0ms"],
  ["step 3 must come before 4 steps", "step 3 must come before 4 steps"],
])("keeps a number and its unit on one line: %s", (text, kept) => {
  expect(keepUnits(text)).toBe(kept);
});

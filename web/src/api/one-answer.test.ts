import { expect, it } from "vitest";

const sources = import.meta.glob<string>(["../**/*.ts", "../**/*.tsx", "!../**/*.test.*"], {
  query: "?raw",
  import: "default",
  eager: true,
});
const QUESTION = /\[("[\w ]+")\],\s*(?:queryFn:\s*)?(?:\(\) => )?([\w.]+)/g;

it("asks each question of one word by one function, so that all who ask it read the same answer", () => {
  const asked = new Map<string, Set<string>>();
  for (const text of Object.values(sources))
    for (const [question] of text.matchAll(/use(?:Asked|Answer)\(([^;]*?)\)/gs))
      for (const [, word, ask] of question.matchAll(QUESTION)) asked.set(word, (asked.get(word) ?? new Set()).add(ask));
  expect(asked.size).toBeGreaterThan(10);
  expect([...asked].filter(([, functions]) => functions.size > 1)).toEqual([]);
});

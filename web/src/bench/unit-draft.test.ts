import { beforeEach, describe, expect, it } from "vitest";
import { beginWith, firstDifference, fitting, lastThatWorked, nameOfClass, useDraft, withVersion } from "./unit-draft";

beforeEach(() => useDraft.setState({ name: "", source: "", versions: {} }));

describe("versions of a unit", () => {
  it("says which line differs first", () => {
    expect(firstDifference("a\nb\nc", "a\nx\nc")).toBe(2);
    expect(firstDifference("a\nb", "a\nb\nc")).toBe(3);
    expect(firstDifference("a\nb\nc", "a\nb")).toBe(3);
  });

  it("keeps fifty, and an equal text once", () => {
    let list = withVersion([], "a", "ran");
    list = withVersion(list, "a", "tripped");
    expect(list.map((v) => [v.source, v.state])).toEqual([["a", "tripped"]]);
    for (let i = 0; i < 60; i++) list = withVersion(list, `a\n${i}`, "ran");
    expect(list).toHaveLength(50);
    expect(list.at(-1)).toMatchObject({ source: "a\n59", line: 2 });
  });

  it("stays within the room of a browser", () => {
    const long = ["a", "b", "c"].reduce(
      (list, text) => withVersion(list, text.repeat(10), "ran"),
      withVersion([], "", "ran"),
    );
    const short = withVersion([], "s", "ran");
    const kept = fitting({ long, short }, 21);
    expect(kept.long.map((v) => v.source[0])).toEqual(["b", "c"]);
    expect(kept.short).toHaveLength(1);
  });

  it("goes back to the last that ran, past those that tripped and the text of now", () => {
    const list = [...withVersion(withVersion([], "good", "ran"), "bad", "tripped"), ...withVersion([], "now", "ran")];
    expect(lastThatWorked(list, "now")?.source).toBe("good");
    expect(lastThatWorked(list, "other")?.source).toBe("now");
    expect(lastThatWorked([], "now")).toBeUndefined();
  });

  it("loses no text that another takes the place of", () => {
    useDraft.setState({ name: "pi", source: "mine" });
    beginWith("pid", "theirs");
    expect(useDraft.getState()).toMatchObject({ name: "pid", source: "theirs" });
    expect(useDraft.getState().versions.pi.map((v) => [v.source, v.state])).toEqual([["mine", "left"]]);
  });
});

describe("the name of a unit", () => {
  it("is that of its class", () => {
    expect(nameOfClass("import x\nclass LeakySquares(Judge):\n")).toBe("leaky_squares");
    expect(nameOfClass("class Pi(Block):")).toBe("pi");
    expect(nameOfClass("x = 1")).toBe("");
  });
});

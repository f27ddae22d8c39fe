import { fireEvent, screen } from "@testing-library/react";
import { useCallback, useState } from "react";
import { expect, it, vi } from "vitest";
import { resize } from "../testing/jsdom-gaps";
import { penOf } from "../testing/recording-pen";
import { mount } from "../testing/render";
import { Painted } from "./painted";
import type { Box, Look, Pen } from "./pen";

const paint = vi.fn((pen: Pen, { width, height }: Box, { scheme }: Look) => {
  pen.fillText(`${width} x ${height}, ${scheme}`, 0, 0);
  return width;
});
const pen = () => penOf(screen.getByRole("img", { name: "A picture" }));

it("paints as large as its place, and anew in another size", () => {
  mount(<Painted label="A picture" paint={paint} />);
  expect(pen().words).toEqual(["800 x 400, dark"]);
  resize(500, 300);
  expect(pen().words).toEqual(["500 x 300, dark"]);
});

it("paints nothing in a place too small", () => {
  mount(<Painted label="A picture" paint={paint} />);
  paint.mockClear();
  resize(50, 300);
  expect(paint).not.toHaveBeenCalled();
});

it("paints anew with a new painter", () => {
  function Change() {
    const [word, setWord] = useState("before");
    const paintWord = useCallback((one: Pen) => one.fillText(word, 0, 0), [word]);
    return (
      <>
        <Painted label="A picture" paint={paintWord} />
        <button type="button" onClick={() => setWord("after")}>
          Change
        </button>
      </>
    );
  }
  mount(<Change />);
  expect(pen().words).toEqual(["before"]);
  fireEvent.click(screen.getByRole("button", { name: "Change" }));
  expect(pen().words).toEqual(["after"]);
});

it("tells where the pointer is in what was painted, and that it has left", () => {
  const point = vi.fn();
  mount(<Painted label="A picture" paint={paint} onPoint={point} />);
  const canvas = screen.getByRole("img");
  fireEvent.pointerMove(canvas);
  expect(point).toHaveBeenLastCalledWith(expect.objectContaining({}), 800);
  fireEvent.pointerLeave(canvas);
  expect(point).toHaveBeenLastCalledWith(undefined, 800);
});

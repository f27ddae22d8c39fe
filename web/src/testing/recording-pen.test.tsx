import { expect, it } from "vitest";
import { RecordingPen } from "./recording-pen";

it("knows where on the canvas a mark is, and in which style", () => {
  const pen = new RecordingPen();
  pen.save();
  pen.translate(10, 20);
  pen.scale(2, 2);
  pen.fillStyle = "#ff0000";
  pen.fillRect(1, 1, 3, 4);
  pen.rotate(Math.PI / 2);
  pen.fillText("up", 1, 0);
  pen.restore();
  pen.setLineDash([4, 2]);
  pen.beginPath();
  pen.moveTo(0, 0);
  pen.lineTo(5, 5);
  pen.stroke();
  expect(pen.rects("#ff0000")).toMatchObject([{ left: 12, right: 18, top: 22, bottom: 30 }]);
  expect(pen.texts[0].points[0][1]).toBeCloseTo(22);
  expect(pen.lines("#000000")).toMatchObject([
    {
      points: [
        [0, 0],
        [5, 5],
      ],
      dashes: [4, 2],
    },
  ]);
  expect(pen.extent).toMatchObject({ left: 0, right: 18, top: 0, bottom: 30 });
});

it("begins a new picture when all of the canvas is cleared, and only then", () => {
  const pen = new RecordingPen();
  pen.fillText("before", 0, 0);
  pen.clearRect(0, 0, 10, pen.canvas.height);
  pen.clearRect(0, 0, pen.canvas.width, 10);
  expect(pen.words).toEqual(["before"]);
  pen.clearRect(0, 0, pen.canvas.width, pen.canvas.height);
  expect(pen.words).toEqual([]);
});

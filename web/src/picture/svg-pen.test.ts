// @vitest-environment jsdom
import { expect, it, vi } from "vitest";
import { SvgPen, svgColour } from "./svg-pen";

vi.spyOn(HTMLCanvasElement.prototype, "getContext").mockReturnValue(null);

const drawn = (draw: (pen: SvgPen) => void) => {
  const pen = new SvgPen();
  draw(pen);
  return new DOMParser().parseFromString(pen.svg(100, 50, "t"), "image/svg+xml");
};

it("passes over what has no place, as a canvas does, and draws no empty path", () => {
  const document = drawn((pen) => {
    pen.beginPath();
    pen.stroke();
    pen.fillText("nowhere", Number.NaN, 0);
    pen.fillRect(0, Number.POSITIVE_INFINITY, 1, 1);
    pen.lineTo(1, 2);
    pen.lineTo(Number.NaN, 3);
    pen.lineTo(4, 5.678);
    pen.stroke();
  });
  expect([...document.querySelectorAll("path")].map((p) => p.getAttribute("d"))).toEqual(["M1 2L4 5.68"]);
  expect(document.querySelectorAll("text, rect")).toHaveLength(1); // the white ground
});

it("writes alpha beside the colour, for programs that cannot read both in one", () => {
  expect(svgColour("#2c55c842")).toEqual({ colour: "#2c55c8", opacity: 66 / 255 });
  expect(svgColour("rgb(196 38 29 / 0.5)")).toEqual({ colour: "#c4261d", opacity: 0.5 });
  expect(svgColour("rgba(44, 85, 200, 0.25)")).toEqual({ colour: "#2c55c8", opacity: 0.25 });
  expect(svgColour("color(srgb 1 0.2 0 / 0.26)")).toEqual({ colour: "#ff3300", opacity: 0.26 });
  expect(svgColour("none")).toEqual({ colour: "none", opacity: 1 });
  const rect = drawn((pen) => {
    pen.fillStyle = "#00000080";
    pen.globalAlpha = 0.5;
    pen.fillRect(5, 5, -3, 2);
  }).querySelector("rect[x]");
  expect(rect?.getAttribute("fill-opacity")).toBe("0.251");
  expect([rect?.getAttribute("x"), rect?.getAttribute("width")]).toEqual(["2", "3"]);
});

it("moves, turns and clips as long as the state that was saved", () => {
  const document = drawn((pen) => {
    pen.save();
    pen.translate(10, 20);
    pen.rotate(-Math.PI / 2);
    pen.beginPath();
    pen.rect(0, 0, 5, 5);
    pen.clip();
    pen.fillStyle = "#ff0000";
    pen.fillRect(1, 1, 1, 1);
    pen.restore();
    pen.fillRect(2, 2, 1, 1);
  });
  expect(document.querySelector("parsererror")).toBeNull();
  const [within, after] = document.querySelectorAll("rect[x]");
  expect(within.parentElement?.getAttribute("clip-path")).toBe("url(#clip1)");
  expect(within.closest("[transform^=rotate]")?.getAttribute("transform")).toBe("rotate(-90)");
  expect(within.closest("[transform^=translate]")?.getAttribute("transform")).toBe("translate(10 20)");
  expect(after.parentElement).toBe(document.documentElement);
  expect(after.getAttribute("fill")).toBe("#000000");
});

it("squeezes a text into the room it has, and sets it by numbers", () => {
  const text = drawn((pen) => {
    pen.font = "650 20px x";
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    pen.fillText("a < b, which is long", 50, 10, 40);
  }).querySelector("text");
  expect(text?.textContent).toBe("a < b, which is long");
  expect(text?.getAttribute("textLength")).toBe("40");
  expect(text?.getAttribute("y")).toBe("17");
  expect(text?.getAttribute("font-weight")).toBe("600");
  expect(text?.getAttribute("text-anchor")).toBe("end");
});

it("closes a circle that ends where it begins", () => {
  const circle = drawn((pen) => {
    pen.arc(10, 10, 4, 0, 2 * Math.PI);
    pen.fill();
  }).querySelector("path");
  expect(circle?.getAttribute("d")).toBe("M14 10A4 4 0 0 1 6 10A4 4 0 0 1 14 10");
});

// @vitest-environment jsdom
import { renderToStaticMarkup } from "react-dom/server";
import { expect, it } from "vitest";
import { Confusion } from "./confusion";

it("tells a few wrong samples from none, and names what was counted", () => {
  const page = document.createElement("div");
  const counts = [
    [199_947, 53],
    [0, 0],
  ];
  page.innerHTML = renderToStaticMarkup(<Confusion title="Kalman bank" names={["healthy", "m+5"]} counts={counts} />);
  const cells = [...page.querySelectorAll("tbody td")];
  expect(cells.map((cell) => cell.textContent)).toEqual(["99.97", "0.03", "·", "·"]);
  expect(cells[1].getAttribute("title")).toBe("53 of 200\u202f000\u00a0samples");
});

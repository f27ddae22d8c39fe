import { screen } from "@testing-library/react";
import { expect, it } from "vitest";
import { mount } from "../testing/render";
import { Prose } from "./prose";

it("keeps a sign with the formula before it, and sets names as code", () => {
  mount(
    <p>
      <Prose text="The drive is :math:`u = r`. It reads ``sensor``, `mode`; nothing else." />
    </p>,
  );
  const paragraph = screen.getByText(/^The drive is/);
  const formula = paragraph.querySelector(".katex-html");
  expect(formula).toHaveTextContent(/^u=r\.$/);
  expect(paragraph).toHaveTextContent(/It reads sensor, mode; nothing else\.$/);
  expect([...paragraph.querySelectorAll("code")].map((one) => one.textContent)).toEqual(["sensor", "mode"]);
});

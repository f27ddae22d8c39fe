import { screen } from "@testing-library/react";
import { expect, it, vi } from "vitest";
import { mount } from "../testing/render";
import { useAnswer } from "./queries";

function Asks({ ask }: { ask: () => Promise<string> }) {
  return <p>{useAnswer(["what"], ask).value}</p>;
}

it("asks nothing for a panel that is hidden, and asks once it is shown", async () => {
  const ask = vi.fn(async () => "this");
  const { show } = mount(<Asks ask={ask} />, { visible: false });
  expect(ask).not.toHaveBeenCalled();
  show(true);
  expect(await screen.findByText("this")).toBeInTheDocument();
  show(false);
  expect(screen.getByText("this")).toBeInTheDocument(); // it may be seen again at once
  expect(ask).toHaveBeenCalledTimes(1);
});

// @vitest-environment jsdom
import { QueryClientProvider } from "@tanstack/react-query";
import { act } from "react";
import { createRoot } from "react-dom/client";
import { expect, it, vi } from "vitest";
import { PanelVisible } from "./panel-visible";
import { queryClient, useAnswer } from "./queries";

Object.assign(globalThis, { IS_REACT_ACT_ENVIRONMENT: true });

function Asks({ ask }: { ask: () => Promise<string> }) {
  return <p>{useAnswer(["what"], ask).value}</p>;
}

it("asks nothing for a panel that is hidden, and asks once it is shown", async () => {
  const ask = vi.fn(async () => "this");
  const page = document.createElement("div");
  const root = createRoot(page);
  const show = (visible: boolean) =>
    act(async () =>
      root.render(
        <QueryClientProvider client={queryClient}>
          <PanelVisible value={visible}>
            <Asks ask={ask} />
          </PanelVisible>
        </QueryClientProvider>,
      ),
    );
  await show(false);
  expect(ask).not.toHaveBeenCalled();
  await show(true);
  await vi.waitFor(() => expect(page.textContent).toBe("this"));
  await show(false);
  expect(page.textContent).toBe("this"); // it may be seen again at once
  expect(ask).toHaveBeenCalledTimes(1);
});

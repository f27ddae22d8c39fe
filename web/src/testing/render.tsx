import { MantineProvider } from "@mantine/core";
import { Notifications } from "@mantine/notifications";
import { QueryClientProvider } from "@tanstack/react-query";
import { render } from "@testing-library/react";
import userEvent from "@testing-library/user-event";
import type { ReactNode } from "react";
import { vi } from "vitest";
import { useMe } from "../api/me";
import { PanelVisible } from "../api/panel-visible";
import { queryClient } from "../api/queries";
import type { Me } from "../api/types";
import { cssVariables, theme } from "../app/theme";

/** Set the person at the page; the default is a teacher. */
export const be = (role: Me["role"], rest: Partial<Me> = {}): void =>
  useMe.setState({ me: { id: role, role, name: role, bench: null, class_id: null, hand: false, ...rest } });

/**
 * Mount a view as the page does, in a panel that is visible by default. Returns the queries of testing-library, a `user` who clicks and
 * types, and `show`, which hides the panel or shows it again.
 */
export function mount(view: ReactNode, { visible = true } = {}) {
  if (!useMe.getState().me) be("teacher");
  const page = (isVisible: boolean) => (
    <QueryClientProvider client={queryClient}>
      <MantineProvider env="test" theme={theme} cssVariablesResolver={cssVariables} forceColorScheme="dark">
        <PanelVisible value={isVisible}>{view}</PanelVisible>
        <Notifications />
      </MantineProvider>
    </QueryClientProvider>
  );
  const user = userEvent.setup(vi.isFakeTimers() ? { advanceTimers: (ms) => vi.advanceTimersByTime(ms) } : {});
  const shown = render(page(visible));
  return { user, ...shown, show: (isVisible: boolean) => shown.rerender(page(isVisible)) };
}

/** A text by its words, for queries: a space matches any white space, such as the no-break space before a unit. */
export const words = (text: string): RegExp =>
  new RegExp(`^${text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&").replace(/ /g, "\\s")}$`);

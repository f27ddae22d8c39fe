import "@fontsource-variable/ibm-plex-sans/wght.css";
import "@mantine/core/styles.css";
import "@mantine/notifications/styles.css";
import "../ui/theme.css";
import "./page.css";
import { MantineProvider } from "@mantine/core";
import { useMediaQuery } from "@mantine/hooks";
import { Notifications } from "@mantine/notifications";
import { QueryClientProvider } from "@tanstack/react-query";
import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { queryClient } from "../api/queries";
import { App } from "./app";
import { cssVariables, theme } from "./theme";

const root = document.getElementById("root");
if (!root) throw new Error("the page has no #root");

createRoot(root).render(
  <StrictMode>
    <QueryClientProvider client={queryClient}>
      <MantineProvider theme={theme} cssVariablesResolver={cssVariables} defaultColorScheme="auto">
        <App />
        <Toasts />
      </MantineProvider>
    </QueryClientProvider>
  </StrictMode>,
);

/** Notes that come and go, where they cover nothing one needs at once: on a phone the stop button is at the bottom. */
export function Toasts() {
  const phone = useMediaQuery("(max-width: 600px)", undefined, { getInitialValueInEffect: false });
  return <Notifications position={phone ? "top-center" : "bottom-right"} limit={phone ? 1 : 4} />;
}

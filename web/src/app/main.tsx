import "@fontsource-variable/ibm-plex-sans/wght.css";
import "@mantine/core/styles.css";
import "@mantine/notifications/styles.css";
import "@mantine/spotlight/styles.css";
import "../ui/theme.css";
import "./page.css";
import { MantineProvider } from "@mantine/core";
import { useMediaQuery } from "@mantine/hooks";
import { Notifications } from "@mantine/notifications";
import { QueryClientProvider } from "@tanstack/react-query";
import { type ReactNode, StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { launch } from "../api/launch";
import { queryClient } from "../api/queries";
import { createStream } from "../stream/create-stream";
import { openSocket } from "../stream/socket";
import { setStream } from "../stream/stream";
import { App } from "./app";
import { NotLaunched } from "./ended";
import { isPresenter, Presenter } from "./lecture/presenter";
import { cssVariables, theme } from "./theme";

/** By which the content policy of the server knows the styles that libraries write; each finds it in its own way. */
const nonce = document.querySelector<HTMLMetaElement>("meta[name=nonce]")?.content ?? "";
Object.assign(window, { __webpack_nonce__: nonce });

const root = document.getElementById("root");
if (!root) throw new Error("the page has no #root");

/** Where the bench of a page without a server is. */
const folder = document.querySelector<HTMLMetaElement>("meta[name=bench]")?.content;

/** A page whose font is late is shown after this time. */
const FONT_MS = 2000;

const page = createRoot(root);
Promise.all([begin(), font()]).then(
  () => show(isPresenter() ? <Presenter /> : <App />),
  (error: unknown) => show(<NotLaunched error={error} />),
);

/** Connect the page to its server, or to the worker that has the bench of a folder. */
async function begin() {
  if (folder === undefined) {
    setStream(createStream(openSocket));
    return launch();
  }
  const { startFolder } = await import("../in-a-folder/start-folder");
  setStream(createStream(startFolder(new URL(folder, document.baseURI))));
}

/** Wait for the font: tabs would move when it comes, and a click in the middle of a tab would meet its cross. */
async function font(): Promise<void> {
  const loaded = document.fonts.load('1em "IBM Plex Sans Variable"').catch(() => undefined);
  await Promise.race([loaded, new Promise((resolve) => window.setTimeout(resolve, FONT_MS))]);
}

function show(content: ReactNode) {
  page.render(
    <StrictMode>
      <QueryClientProvider client={queryClient}>
        <MantineProvider
          theme={theme}
          cssVariablesResolver={cssVariables}
          defaultColorScheme="auto"
          getStyleNonce={() => nonce}
        >
          {content}
          <Toasts />
        </MantineProvider>
      </QueryClientProvider>
    </StrictMode>,
  );
}

/** Notes that come and go, where they cover nothing one needs at once: on a phone the stop button is at the bottom. */
export function Toasts() {
  const phone = useMediaQuery("(max-width: 600px)", undefined, { getInitialValueInEffect: false });
  return <Notifications position={phone ? "top-center" : "bottom-right"} limit={phone ? 1 : 4} />;
}

import { test } from "@playwright/test";
import { PROXY_BROWSER, walkBehindProxy } from "./proxy-server";

test.use(PROXY_BROWSER);

test("behind a proxy with TLS, below a path, the page, its stream, its 3D view and its links work", async ({
  page,
}) => {
  await walkBehindProxy(page, "/bench");
});

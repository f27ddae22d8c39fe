import type { Page } from "@playwright/test";
import { benchOf, expect, test } from "./classroom";
import { chooseMore, chooseTool, front } from "./lab";
import type { LabServer } from "./lab-server";

const momentOf = (server: LabServer, page: Page) =>
  server.ask<{ tick: number; digest: string }>("GET", `/benches/${benchOf(page)}/digest`);

test("links to an experiment and to a layout open the same tick, log, cursors and panels elsewhere", async ({
  page,
  openBench,
  elsewhere,
  server,
}) => {
  await openBench("lab");
  await page.getByRole("button", { name: /^Inject \+5.*Added mass$/ }).click();
  await server.advance(1);
  await page.getByRole("button", { name: "Pause" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await front(page, "Log", "Events");
  await chooseTool(page.getByRole("region", { name: /^Scope: / }).first(), /^Measure/);
  const cursor = page.getByRole("slider", { name: "Cursor A" });
  await cursor.press("ArrowLeft");
  await cursor.press("ArrowLeft");
  await expect(cursor).toHaveAttribute("aria-valuenow", "23");
  await chooseMore(page, /^Share this experiment/);
  const link = page.getByRole("textbox", { name: "Link", exact: true });
  await expect(link).toHaveValue(new RegExp(`^${server.origin}/\\?link=[2-9a-z]{8}$`));
  await expect(page.getByRole("img", { name: /^QR code of/ })).toBeVisible();
  await page.getByLabel("Note").fill("Watch the mass.");
  await page.getByRole("button", { name: "Copy", exact: true }).click();
  await expect(page.getByRole("button", { name: "Copied" })).toBeVisible();

  const other = await elsewhere({ width: 1440, height: 900 });
  await other.request.get(server.url);
  await other.goto(await link.inputValue());
  await expect(other.getByTestId("bench-state")).toHaveText("paused");
  expect(benchOf(other)).not.toBe(benchOf(page));
  expect(await momentOf(server, other)).toEqual(await momentOf(server, page));
  await expect(other.getByRole("region", { name: "Note of the link" })).toContainText("Watch the mass.");
  await expect(other.getByRole("tab", { name: "Log", exact: true })).toHaveAttribute("aria-selected", "true");
  const log = other.getByRole("list", { name: "Events, newest first" });
  await expect(log.getByText(/added.mass/i).first()).toBeVisible();
  const same = other.getByRole("slider", { name: "Cursor A" });
  await expect(same).toHaveAttribute("aria-valuenow", "23");
  await other.reload();
  await expect(same).toHaveAttribute("aria-valuenow", "23");

  await page.keyboard.press("Escape");
  await front(page, "Voltage");
  await page.getByRole("tab", { name: "Voltage", exact: true }).locator(".dock-close").click();
  await chooseMore(page, /^Save, rename or share/);
  const sheet = page.getByRole("dialog", { name: "Layouts" });
  await sheet.getByLabel("Save this layout").fill("Motion alone");
  await sheet.getByRole("button", { name: "Save" }).click();
  await sheet.getByRole("button", { name: "Make a link of the Motion alone layout" }).click();
  const layout = sheet.getByLabel("Link of the layout");
  await expect(layout).toHaveValue(/\?layout=[2-9a-z]{8}$/);
  await other.goto(await layout.inputValue());
  await expect(other.getByRole("tab", { name: "Displacement", exact: true })).toBeVisible();
  await other.getByRole("button", { name: "More", exact: true }).click();
  await expect(other.getByRole("menuitem", { name: "Motion alone" })).toHaveAttribute("aria-current", "true");
  await expect(other.getByRole("tab", { name: "Voltage", exact: true })).toHaveCount(0);
});

test("a shared link lets people without a token watch, once the teacher allows it, until the permission ends", async ({
  page,
  openBench,
  elsewhere,
}) => {
  await openBench("lab");
  await chooseMore(page, /^Share this experiment/);
  const link = page.getByRole("textbox", { name: "Link", exact: true });
  await expect(link).toHaveValue(/\?link=/);
  const guest = await elsewhere();
  await guest.goto(await link.inputValue());
  await expect(guest.getByRole("alert")).toContainText("This link does not let you watch");
  await page.getByRole("button", { name: "Let people watch" }).click();
  await expect(page.getByText("All others watch this bench live")).toBeVisible();
  const sent: string[] = [];
  guest.on("websocket", (socket) => socket.on("framesent", ({ payload }) => sent.push(String(payload))));
  await guest.goto(await link.inputValue());
  await expect(guest.getByTestId("bench-state")).toHaveText("running");
  await expect(guest.getByText("You watch this bench").first()).toBeVisible();
  for (const name of ["Pause", /^Step$/, /^Inject/]) await expect(guest.getByRole("button", { name })).toHaveCount(0);
  for (const key of [" ", "h", "c", "R", "2"]) await guest.keyboard.press(key);
  await expect(guest.getByRole("region", { name: /^Scope/ }).first()).toBeVisible();
  await page
    .getByRole("list", { name: "Links by which people watch this bench" })
    .getByRole("button", { name: "End" })
    .click();
  await expect(guest.getByText("The link to watch has ended")).toBeVisible();
  expect(sent.filter((text) => text.includes('"command"'))).toEqual([]);
});

test("a visitor needs a token, has a bench, joins another by its address, and a dead link leads on", async ({
  page,
  elsewhere,
  server,
}) => {
  await page.goto(`${server.origin}/?scenario=ch5-seven-step`);
  await expect(page.getByRole("heading", { name: "CombBench" })).toBeVisible();
  await expect(page.getByText("Ask the person who runs it")).toBeVisible();
  await page.getByLabel("Access token").fill("guessed");
  await page.getByRole("button", { name: "Open" }).click();
  await expect(page.getByRole("alert")).toHaveText("This token is not the one of this bench.");
  await page.getByLabel("Access token").fill(new URL(server.url).searchParams.get("token") ?? "");
  await page.getByRole("button", { name: "Open" }).click();
  await expect(page.getByTestId("bench-state")).toBeVisible();
  expect(page.url()).not.toContain("token");

  const other = await elsewhere();
  await other.goto(server.url);
  await expect(other.getByTestId("bench-state")).toHaveText("running");
  const own = benchOf(other);
  await expect.poll(() => benchOf(page)).not.toBe("");
  expect(benchOf(page)).not.toBe(own);
  await page.goto(other.url());
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await server.advance(1);
  await expect(page.getByTitle(/2 watching\./)).toBeVisible();
  await other.getByRole("button", { name: "Pause" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");

  await other.goto(`${server.origin}/?link=nothere2`);
  await expect(other.getByText("there is no link 'nothere2'")).toBeVisible();
  await other.getByRole("button", { name: "Open my own bench" }).click();
  await expect(other.getByTestId("bench-state")).toHaveText("paused");
  expect(benchOf(other)).toBe(own);
});

import { type ChildProcess, spawn } from "node:child_process";
import { once } from "node:events";
import { join } from "node:path";
import type { Page } from "@playwright/test";
import { expect, test } from "./lab";
import { freePort, LabServer } from "./lab-server";
import { sceneOf } from "./scene";

const ROOT = join(import.meta.dirname, "..", "..");

// The course is at 127.0.0.1 and the bench at localhost: two sites; in a frame the second gets no cookie. Data
// of pages of the second site is kept apart for each first site, as browsers do; that is off in tests unless a list is
// given.
const FLAGS = ["--test-third-party-cookie-phaseout", "--disable-features=HttpsUpgrades,Translate"];

test.use({
  drawn: true,
  launchOptions: async ({ launchOptions }, use) => {
    await use({ ...launchOptions, args: [...(launchOptions.args ?? []), ...FLAGS] });
  },
});

let lab: LabServer;
let platform: ChildProcess;
let course = "";
let bench = "";

test.beforeAll(async () => {
  const port = await freePort();
  course = `http://127.0.0.1:${port}`;
  const known = {
    issuer: course,
    client_id: "combbench",
    auth_login_url: `${course}/auth`,
    auth_token_url: `${course}/token`,
    key_set_url: `${course}/keys`,
    deployment_ids: ["1"],
    frames: [course],
  };
  lab = await LabServer.create({
    COMBBENCH_LTI: JSON.stringify([known]),
    NO_PROXY: "127.0.0.1",
  });
  bench = `http://localhost:${lab.port}`;
  platform = spawn(
    join(ROOT, ".venv", "bin", "python"),
    ["-m", "tests.server.classroom.lti.platform", String(port), bench, "first-look"],
    { cwd: ROOT, stdio: ["pipe", "pipe", "inherit"] },
  );
  if (!platform.stdout || !platform.stdin) throw new Error("the platform has no pipes");
  await once(platform.stdout, "data");
});

test.afterAll(async () => {
  platform?.stdin?.end();
  await lab?.destroy();
});

/** The refusals of the server, for a test that expects none. */
function refusals(page: Page): string[] {
  const refused: string[] = [];
  page.on("response", (answer) => answer.status() >= 400 && refused.push(`${answer.status()} ${answer.url()}`));
  return refused;
}

/** The frame of the exercise, once it has gone through the pages of the launch: nothing is asked of a page that goes. */
async function arrived(page: Page) {
  const isThere = (url: string) => url.startsWith(`${bench}/`) && !/\/lti\/|launch=/.test(url);
  await expect.poll(() => page.frames().some((one) => isThere(one.url()))).toBe(true);
  return page.frameLocator("iframe[title='Exercise']");
}

test("a launch in a frame has bench, stream and 3D view without a cookie, a launch in a tab has the usual cookie", async ({
  page,
}) => {
  const refused = refusals(page);
  await page.goto(`${course}/course`);
  const frame = await arrived(page);
  await expect(frame.getByTestId("bench-state")).toHaveText("running");
  await expect(frame.getByText("Ada Lovelace")).toBeVisible();
  await expect(frame.locator("section[aria-label='Lab sheet']")).toBeVisible();
  const inside = page.frames().find((one) => one.url().startsWith(bench));
  if (!inside) throw new Error("there is no frame of the bench");
  expect(inside.url()).not.toContain("launch=");

  // this browser really keeps no cookie of the bench
  const kept = await inside.evaluate(() => {
    // biome-ignore lint/suspicious/noDocumentCookie: the other interface is not there in all browsers
    document.cookie = "probe=1; SameSite=None; Secure";
    return document.cookie;
  });
  expect(kept).toBe("");
  expect(await page.context().cookies()).toEqual([]);

  await frame.getByTestId("bench-state").click();
  await page.keyboard.press("1"); // the lecture layout has the device in view
  await expect(sceneOf(frame)).toBeVisible();
  await expect(frame.getByText("The 3D view is loading")).toHaveCount(0); // it goes once the scene is connected
  await expect(frame.getByText("The 3D view waits")).toHaveCount(0);

  await frame.getByRole("button", { name: "Pause" }).click();
  await expect(frame.getByTestId("bench-state")).toHaveText("paused");
  await frame.getByRole("button", { name: "Run", exact: true }).click();
  await expect(frame.getByTestId("bench-state")).toHaveText("running");
  // a figure of the gallery is a picture that the browser loads by itself
  expect(refused.filter((line) => !line.includes("/gallery/"))).toEqual([]);

  // a frame alone that is loaded again has nothing to show for itself
  await inside.evaluate(() => window.location.reload());
  await expect(frame.getByText("Open the exercise again from your course.")).toBeVisible();

  // a page of another origin may not show it
  const said = page.waitForEvent("console", (message) => message.text().includes("frame-ancestors"));
  await page.goto(`${course.replace("127.0.0.1", "localhost")}/course`);
  expect((await said).text()).toContain(course);

  // in a tab of its own it gets the usual cookie, and comes back after a reload
  await page.goto(`${course}/course?link=1`);
  await page.getByRole("link", { name: "Open here" }).click();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  expect(page.url()).toMatch(new RegExp(`^${bench}/\\?layout=lab&bench=`));
  const cookies = await page.context().cookies();
  expect(cookies.map(({ httpOnly, sameSite }) => ({ httpOnly, sameSite }))).toEqual([
    { httpOnly: true, sameSite: "Strict" },
  ]);
  const clock = page.getByRole("timer", { name: "Device time" });
  const before = await clock.innerText();
  await lab.advance(1);
  await expect(clock).not.toHaveText(before);
  await page.reload();
  await expect(page.getByText("Ada Lovelace")).toBeVisible();
  await page.goto(`${bench}/lti#launch=used&state=state-used`);
  await expect(page.getByText("Open the exercise again from your course.")).toBeVisible();
});

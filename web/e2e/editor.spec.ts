import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Locator, Page } from "@playwright/test";
import { expect, test } from "./lab";
import type { LabServer } from "./lab-server";

const ROOT = join(import.meta.dirname, "..", "..");
const PID = readFileSync(join(ROOT, "core", "control", "pid.py"), "utf-8");
const DOCUMENT = readFileSync(join(ROOT, "docs", "own-units.md"), "utf-8");
const PI = DOCUMENT.split("```python\n")[1].split("```")[0];

/** Four weeks of ageing make the suspension 1/0.572 times as stiff; so much more voltage is fed forward. */
const AGED_PI = PI.replace("proportional = p.", "proportional = 1.75 * x.reference + p.");
const SCENARIO = "ch3-case1-aged-mass";

interface Summary {
  digest: string;
  metrics: Record<string, number>;
}

/** A headless run by REST, when it is done. */
async function run(server: LabServer, set: Record<string, unknown>): Promise<Summary> {
  const { id } = await server.ask<{ id: string }>("POST", "/runs", { scenario: SCENARIO, set });
  let summary: Summary | null = null;
  await expect
    .poll(async () => {
      summary = (await server.ask<{ summary: Summary | null }>("GET", `/runs/${id}`)).summary;
      return summary;
    })
    .not.toBeNull();
  return summary as unknown as Summary;
}

/** The same by the command line, with a file. */
function runByHand(name: string, source: string): Summary {
  const folder = mkdtempSync(join(tmpdir(), "combbench-unit-"));
  try {
    const file = join(folder, `${name}.py`);
    writeFileSync(file, source);
    const told = ["run", SCENARIO, "--unit", file, "--set", `controller.kind=${name}`, "--json"];
    let out: string;
    try {
      out = execFileSync(join(ROOT, ".venv", "bin", "combbench"), told, { encoding: "utf-8" });
    } catch (error) {
      out = (error as { stdout: string }).stdout; // other expectations belong to the adaptive law
    }
    return JSON.parse(out) as Summary;
  } finally {
    rmSync(folder, { recursive: true });
  }
}

const editor = (page: Page): Locator => page.getByRole("region", { name: "Editor" });
const text = (page: Page): Locator => editor(page).getByRole("textbox", { name: "Text of the unit" });
const state = (page: Page): Locator => editor(page).getByRole("status");

/** A bench of the scenario in the lab layout. */
async function openBench(page: Page, server: LabServer, set: object = {}): Promise<void> {
  await page.request.get(server.url);
  const bench = { scenario: SCENARIO, time_scale: 0.001, set };
  const { id } = await server.ask<{ id: string }>("POST", "/benches", bench);
  await page.goto(`${server.origin}/?bench=${id}&layout=lab`);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
}

/** The same with an empty editor. */
async function openEditor(page: Page, server: LabServer): Promise<void> {
  await openBench(page, server);
  await page.keyboard.press("o");
  await expect(text(page)).toBeVisible();
}

async function paste(page: Page, source: string): Promise<void> {
  await text(page).click();
  await page.keyboard.press("ControlOrMeta+a");
  await page.keyboard.insertText(source);
}

/** Run the unit headless from the panel; its digest. */
async function runFromPanel(page: Page): Promise<string> {
  const headless = editor(page).getByRole("region", { name: "Headless run" });
  await headless.getByRole("button", { name: "Use in a run" }).click();
  const digest = headless.locator("dl > div").filter({ hasText: "Digest" }).locator("dd");
  await expect(digest).toHaveText(/^[0-9a-f]{64}$/);
  return digest.innerText();
}

test("a PI typed into an empty editor drives, beats the PID, and is the same by command line and REST", async ({
  page,
  server,
}) => {
  await openEditor(page, server);
  await expect(state(page)).toHaveText("Empty.");
  await paste(page, AGED_PI.replace(/x\.error = e\s*$/, ""));
  await page.keyboard.press("ControlOrMeta+End");
  await page.keyboard.type("x.error = e");
  await expect(state(page)).toContainText("It runs on this bench");
  await expect(editor(page).locator(".katex").first()).toBeVisible();
  const typed = await page.evaluate(() => JSON.parse(localStorage.getItem("combbench.unit") ?? "").state.source);
  await editor(page).getByRole("button", { name: "Let it drive" }).click();
  await expect(editor(page).getByText("It drives.")).toBeVisible();
  await editor(page).getByRole("button", { name: "Show its signals" }).click();
  await expect(page.getByRole("region", { name: "Scope: pi.voltage, pi.error" })).toBeVisible();
  const found = await runFromPanel(page);
  const ours = await run(server, { "units.pi.source": typed, "controller.kind": "pi" });
  const pid = await run(server, { "controller.kind": "pid" });
  expect(ours.metrics["control.rms_error_um"]).toBeLessThan(pid.metrics["control.rms_error_um"]);
  expect([ours.digest, runByHand("pi", typed).digest]).toEqual([found, found]);
});

test("a mistake is said with its place, a text that trips is marked, and the last that worked comes back", async ({
  page,
  server,
}) => {
  await openEditor(page, server);
  await paste(page, PI);
  await expect(state(page)).toContainText("It runs on this bench");
  const bench = page.url();
  const wrong = PI.replace("e = x.model - x.measured", "e = x.model - x.truth");
  await paste(page, wrong);
  const line = 1 + wrong.split("\n").indexOf("        e = x.model - x.truth");
  await expect(state(page)).toContainText(`Line ${line}, column 23: has no truth`);
  await expect(editor(page).locator(".cm-lintRange-error")).toHaveText("x.truth");
  await paste(page, PI.replace('"PI"', '"PI of today"'));
  await expect(state(page)).toContainText("It runs on this bench");
  expect(page.url(), "the same signals need no other bench").toBe(bench);
  await editor(page).getByLabel("Version").selectOption({ index: 2 });
  const difference = editor(page).getByRole("region", { name: "Difference" });
  await expect(difference.locator(".cm-deletedChunk")).toContainText('title = "PI"');
  await difference.getByRole("button", { name: "Close" }).click();
  await page.reload();
  await expect(page.getByTestId("bench-state")).toBeVisible();
  await page.keyboard.press("o");
  await expect(text(page)).toContainText('title = "PI of today"');
  const goBack = async () => {
    await editor(page).getByRole("button", { name: "Back to the last that worked" }).click();
    await expect(text(page)).toContainText("x.voltage = proportional");
    await expect(state(page)).toContainText("It runs on this bench");
  };
  await goBack();
  await expect(text(page)).toContainText('title = "PI"');

  await editor(page).getByRole("button", { name: "Let it drive" }).click();
  await expect(editor(page).getByText("It drives.")).toBeVisible();
  await paste(page, PI.replace("x.voltage = proportional", "x.voltage = (e - e) / (e - e)"));
  const later = async () => {
    await server.advance(0.5);
    return state(page).innerText();
  };
  await expect.poll(later).toContain("it has tripped the bench"); // once it is compiled, and a tick has passed
  await expect(page.getByTestId("bench-state")).toHaveText("tripped");
  await expect(editor(page).getByLabel("Version")).toContainText("tripped the bench");
  await goBack();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
});

test("the PID of the library gives its own digest when it is pasted; a copy of its block is kept on the server", async ({
  page,
  server,
}) => {
  const set = { "controller.kind": "pid" };
  await openEditor(page, server);
  await paste(page, PID);
  await expect(editor(page).getByLabel("Name of the unit")).toHaveValue("pid");
  await expect(state(page)).toContainText("It runs on this bench");
  const found = await runFromPanel(page);
  const ours = await run(server, { "units.pid.source": PID, ...set });
  expect([found, ours.digest]).toEqual(Array(2).fill((await run(server, set)).digest));

  await openBench(page, server, set);
  await page.getByRole("button", { name: /^Controller PID/ }).click();
  await page.getByRole("button", { name: "Edit a copy" }).click();
  await expect(editor(page).getByLabel("Name of the unit")).toHaveValue("my_pid");
  await expect(text(page)).toContainText("class Pid");
  const file = async (item: string) => {
    await editor(page).getByRole("button", { name: "File" }).click();
    await page.getByRole("menuitem", { name: item }).click();
  };
  await file("Keep on this server");
  await expect(page.getByText("my_pid is kept on this server")).toBeVisible();
  expect((await server.ask<{ source: string }>("GET", "/units/my_pid")).source).toBe(PID);
  await file("Delete from this server");
  await expect.poll(() => server.ask("GET", "/units/my_pid").catch(() => "gone")).toBe("gone");
});

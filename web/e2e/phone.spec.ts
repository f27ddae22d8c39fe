import { benchOf, expect, join, PHONE, test } from "./classroom";
import { openOnPhone, SCHEMES } from "./screens";
import { faintLetters, seriousViolations } from "./serious-violations";

test.use({ viewport: PHONE, hasTouch: true });

test("a student on a phone runs, switches, injects and works at a sheet with the scope in sight, and finds a hidden fault", async ({
  page,
  server,
  group,
}) => {
  await join(page, server, group.code, "Ada");
  const scope = page.getByRole("region", { name: /^Scope/ });
  const lanes = page.getByRole("region", { name: "Diagnosis by kalman" });
  const bar = page.getByRole("group", { name: "Bench" });
  await expect(scope).toBeInViewport();
  await expect(lanes).toBeInViewport();
  await bar.getByRole("button", { name: "Stop" }).tap();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await bar.getByRole("button", { name: "Run", exact: true }).tap();
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  for (const button of await bar.getByRole("button").all()) {
    const box = await button.boundingBox();
    expect(box?.height).toBeLessThan(64);
    expect(box?.y, "within one reach of the thumb").toBeGreaterThan(PHONE.height - 80);
  }

  await bar.getByRole("button", { name: "Faults" }).tap();
  await page.getByRole("button", { name: /^Inject \+5.*Added mass$/ }).tap();
  await expect(page.getByText(/^1\sactive fault$/)).toBeVisible();
  await expect(scope).toBeInViewport();
  await server.advanceTicks(benchOf(page), 1500);
  await bar.getByRole("button", { name: "Faults" }).tap();
  await expect(lanes.getByText(/^mass \+5/).first()).toBeVisible();
  await bar.getByRole("button", { name: "Controller" }).tap();
  await page.getByRole("radio", { name: "PID" }).tap();
  await expect(page.getByRole("radio", { name: "PID" })).toBeChecked();

  await bar.getByRole("button", { name: "Lab sheet" }).tap();
  const sheets = page.getByRole("region", { name: "Lab sheets" });
  await expect(sheets).toBeInViewport();
  const divider = page.getByRole("separator", { name: "Height of the scope" });
  const before = (await scope.boundingBox())?.height ?? 0;
  await divider.focus();
  await page.keyboard.press("ArrowUp");
  await expect.poll(async () => (await scope.boundingBox())?.height).toBeLessThan(before - 20);
  const line = await divider.boundingBox();
  await page.mouse.move(PHONE.width / 2, (line?.y ?? 0) + 8);
  await page.mouse.down();
  await page.mouse.move(PHONE.width / 2, 500);
  await page.mouse.up();
  await expect.poll(async () => (await scope.boundingBox())?.height).toBeGreaterThan(before);

  await openOnPhone(page, "labs");
  await expect(page.getByRole("slider").first()).toBeVisible();
  const small = await page.locator("button, [role=slider], [role=separator]").evaluateAll((targets) =>
    targets
      .filter((target) => {
        const { width, height } = target.getBoundingClientRect();
        return width > 0 && Math.min(width, height) < 24;
      })
      .map((target) => target.getAttribute("aria-label") ?? target.textContent),
  );
  expect(small, "targets too small for a finger").toEqual([]);
  expect(await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth)).toBeLessThanOrEqual(0);

  await openOnPhone(page, "blind");
  await page.getByRole("button", { name: "Hide a fault" }).tap();
  await expect(bar.getByRole("button", { name: "Answer" })).toHaveAttribute("aria-pressed", "true");
  await expect(page.getByRole("slider", { name: "How sure are you, percent" })).toBeInViewport();
  await expect(page.getByRole("button", { name: "Commit the answer" })).toBeInViewport();
  await bar.getByRole("button", { name: "Answer" }).tap();
  await expect(page.getByRole("button", { name: "Sweep the device" })).toBeInViewport();

  await bar.getByRole("button", { name: "More" }).tap();
  await expect(page.getByRole("dialog", { name: "Panels" })).toBeVisible();
  expect(await seriousViolations(page), "the list of panels").toEqual([]);
  await page.keyboard.press("Escape");
  await expect(page.getByRole("dialog")).toHaveCount(0);
  expect(await seriousViolations(page), "the bench").toEqual([]);
  for (const colorScheme of SCHEMES) {
    await page.emulateMedia({ colorScheme });
    expect(await faintLetters(page), colorScheme).toEqual([]);
  }
});

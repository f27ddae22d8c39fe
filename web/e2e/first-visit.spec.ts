import { benchOf } from "./classroom";
import { expect, SCOPE_CANVAS, test } from "./lab";

interface Event {
  kind: string;
  tick: number;
}

const LATER = [
  "Added mass +10",
  "Added mass removed, beam stiffness +5",
  "Beam stiffness +10",
  "Beam stiffness removed, damping +30",
  "healed",
];

test("a first visit opens a running bench, ticks off the tried actions, and shows the seven steps at a press", async ({
  page,
  server,
}) => {
  await page.goto(server.url);
  await expect(page.getByTestId("bench-state")).toHaveText("running");
  await expect(page.locator(SCOPE_CANVAS).first()).toBeVisible();
  await expect(page).not.toHaveURL(/token/);
  await expect(page.locator("html")).toHaveAttribute("data-size", "large");
  await expect(page.getByText("A live comb resonator: a voltage shakes a plate on thin beams.")).toBeVisible();
  await expect(page.getByRole("img", { name: /Probability of healthy, mass \+5\s%, mass \+10\s%/ })).toBeVisible();
  const first = benchOf(page);

  const next = page.getByRole("region", { name: "Try this" });
  await expect(next).toContainText(/\(1 of 3\): inject Added mass/);
  await server.advance(2);
  await page.getByRole("button", { name: /^Inject \+5.*Added mass$/ }).click();
  await expect(next).toContainText(/\(2 of 3\): watch Diagnosis/);
  await server.advance(5);
  await expect(next).toContainText(/\(3 of 3\)/);
  await page.getByRole("button", { name: "All hints" }).click();
  const ticked = page.getByRole("region", { name: "Things to try" }).locator("li[data-done=true]");
  await expect(ticked).toHaveText([/^inject Added mass/, /^watch Diagnosis/]);
  await page.keyboard.press("Escape");

  await page.getByRole("button", { name: "Run the seven steps" }).click();
  await expect.poll(() => benchOf(page)).not.toBe(first);
  const steps = page.getByRole("region", { name: "Steps of the scenario" });
  await expect(steps).toContainText(/2 of 7: Added mass \+5\s%, in 2\ss/);
  const id = benchOf(page);
  const leaps = async () => {
    const { events } = await server.ask<{ events: Event[] }>("GET", `/benches/${id}/events`);
    return events.filter(({ kind }) => kind === "fast_forward").length;
  };
  for (const [i, words] of LATER.entries()) {
    await server.advance(4);
    await expect(steps).toContainText(`${i + 3} of 7: ${words}`);
    await steps.getByRole("button", { name: "Skip" }).click();
    await expect.poll(leaps).toBe(i + 2);
  }
  await server.advance(4);
  await steps.getByRole("button", { name: "To the end" }).click();
  await expect.poll(leaps).toBe(LATER.length + 2);
  await server.advance(4);
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  const found = page.getByRole("list", { name: "Findings at each step" }).getByRole("listitem");
  await expect(found).toHaveCount(0);
  await page.getByRole("button", { name: "Findings" }).click();
  await expect(found).toHaveCount(7);
  await expect(found.nth(1)).toContainText(/2 Added mass \+5\s%.*found mass \+5\s% after \d/);
  await expect(found.nth(6)).toContainText(/7 healed.*found healthy after/);
  await found.getByRole("button", { name: /^2 Added mass/ }).click();
  await expect.poll(leaps).toBe(LATER.length + 3);
  await server.advance(0.5);
  await expect(steps).toContainText(/2 of 7: Added mass \+5\s%, in 2\ss/);

  await page.goBack();
  await expect.poll(() => benchOf(page)).toBe(first);
  await page.getByRole("button", { name: "Dismiss the hints" }).click();
  await expect(next).toHaveCount(0);
  await page.reload();
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await expect(next).toHaveCount(0);

  const controls = page.getByRole("button", { name: "Run", exact: true });
  await expect(controls).toHaveCount(1);
  await page.keyboard.press("j");
  await expect(page.getByRole("heading", { name: "Benchmark" })).toBeVisible();
  await expect(controls).toHaveCount(0);
  await page.getByRole("button", { name: "Back to the bench" }).click();
  await expect(controls).toHaveCount(1);
});

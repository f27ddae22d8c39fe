import { benchOf, expect, test } from "./classroom";
import { front } from "./lab";

interface Play {
  attempts: { outcome: { points: number; figures: Record<string, number> } }[];
  bench: string | null;
}

interface Shown {
  parameters: { diagnosers?: { kalman?: Record<string, number> } };
}

/** Points as the page writes them. */
const written = (points: number) => points.toFixed(1).replace("-", "\u2212");

test("a student plays be the filter: knobs turn the hidden bench, and the settings handed in earn points", async ({
  server,
  student,
}) => {
  const page = await student("Ada");
  await page.goto(`${server.origin}/?bench=${benchOf(page)}&layout=lab`);
  await expect(page.getByTestId("bench-state")).toHaveText(/^(running|paused)$/);
  await front(page, "Lesson", "Games");
  const panel = page.locator("section[aria-label='Games']");
  const fill = async (name: RegExp, value: string) => {
    await panel.getByRole("textbox", { name }).fill(value);
    await panel.getByRole("textbox", { name }).press("Enter");
  };
  await fill(/^Seed/, "11");
  await expect(panel.getByText("5 attempts left")).toBeVisible();
  await panel.getByRole("button", { name: "Play on a new bench" }).click();
  await expect(page.getByText("A game is played here, seed 11")).toBeVisible();
  await expect(panel.getByRole("button", { name: "Begin again" })).toBeVisible();
  const play = async () =>
    (await page.request.get(`${server.origin}/api/v1/games/be-the-filter?seed=11`)).json() as Promise<Play>;
  const id = (await play()).bench;
  const bench = () => server.ask<Shown>("GET", `/benches/${id}`);
  await expect.poll(() => benchOf(page)).toBe(id);
  await fill(/^Process noise/, "0.7");
  await expect.poll(async () => (await bench()).parameters.diagnosers?.kalman?.process_noise_v).toBe(0.7);
  await fill(/^Mass/, "1.1");
  await panel.getByRole("button", { name: "Begin again" }).click(); // the sixth hypothesis needs it
  await expect.poll(async () => (await play()).bench).not.toBe(id);
  await expect(page.getByRole("region", { name: "Diagnosis by kalman" })).toBeVisible();
  await expect(page.getByRole("img", { name: /^Probability of .*sixth/ })).toBeVisible();

  await panel.getByRole("button", { name: "Hand in" }).click();
  await expect(panel.getByText("4 attempts left")).toBeVisible();
  const [{ outcome }] = (await play()).attempts;
  await expect(panel.getByRole("status")).toContainText(`${written(outcome.points)} points`);
  await expect(panel.getByRole("status")).toContainText(
    `default settings earn ${written(outcome.figures.default_points)}`,
  );
  await expect(panel.getByRole("row").nth(1)).toContainText(written(outcome.points));
  await expect(panel.getByRole("row").nth(1)).toContainText("mass 1.1");
  await expect(panel.getByLabel("Solution")).toHaveCount(0);

  await panel.getByRole("button", { name: "Show the solution" }).click();
  await expect(panel.getByLabel("Solution")).toContainText("Unknown fault");
  await expect(page.getByText("A game is played here")).toHaveCount(0);
  await expect(panel.getByRole("button", { name: "Hand in" })).toBeDisabled();
  await panel.getByRole("button", { name: "Next seed" }).click();
  await expect(panel.getByText("5 attempts left")).toBeVisible();
});

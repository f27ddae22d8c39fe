import { expect, test } from "./lab";
import { expectFits } from "./screens";
import { seriousViolations } from "./serious-violations";

test("a visitor without a token is told what this is and whom to ask, and goes on with one", async ({
  page,
  server,
}) => {
  await page.goto(`${server.origin}/?scenario=ch5-seven-step`);
  await expect(page.getByRole("heading", { name: "CombBench" })).toBeVisible();
  await expect(page.getByText("Ask the person who runs it")).toBeVisible();
  await seriousViolations(page).then((found) => expect(found).toEqual([]));
  await expectFits(page, "the page of a visitor");
  if (process.env.SHOTS) await page.screenshot({ path: `${process.env.SHOTS}/visitor.png` });

  await page.getByLabel("Access token").fill("guessed");
  await page.getByRole("button", { name: "Open" }).click();
  await expect(page.getByRole("alert")).toHaveText("This token is not the one of this bench.");
  await expectFits(page, "a wrong token");

  await page.getByLabel("Access token").fill(new URL(server.url).searchParams.get("token") ?? "");
  await page.getByRole("button", { name: "Open" }).click();
  await expect(page.getByTestId("bench-state")).toBeVisible();
  expect(page.url()).not.toContain("token");
});

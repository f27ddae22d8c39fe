import { benchOf } from "../classroom";
import { expect, test } from "../lab";
import { expectClean } from "../screens";

test("every lecture begins from the gallery and comes to its last cue", async ({ page, openBench, server }) => {
  const { lectures } = await server.ask<{ lectures: { id: string; title: string; cues: number }[] }>(
    "GET",
    "/lectures",
  );
  const strip = page.getByRole("region", { name: "Lecture", exact: true });
  await openBench("lab");
  const before = benchOf(page);
  for (const [i, { title, cues }] of lectures.entries()) {
    if (i === 0) await page.keyboard.press("e"); // leaving comes back to the gallery
    await page.getByText(/^5\slectures with notes/).click();
    await page.getByRole("button", { name: `Start ${title}` }).click();
    await expect(strip).toContainText(`1 of ${cues}`);
    await page.getByRole("button", { name: "All cues" }).click();
    await page.getByRole("menuitem").last().click();
    await expect(strip).toContainText(`${cues} of ${cues}`);
    await expect(page.locator(".mantine-Notification-root")).toHaveCount(0);
    if (i === 0) await expectClean(page, "a lecture", "[aria-label=Lecture]");
    await strip.getByRole("button", { name: "Leave" }).click();
    await expect(strip).toHaveCount(0);
  }
  await expect.poll(() => benchOf(page)).toBe(before);
});

import { expect, test } from "./lab";

test("what is known to be weak stands beside the block, on its card and where it is chosen", async ({
  page,
  openBench,
  server,
}) => {
  const { blocks } = await server.ask<{ blocks: { family: string; name: string; weaknesses: string[] }[] }>(
    "GET",
    "/catalog",
  );
  const weaknesses = (family: string, name: string) =>
    blocks.find((b) => b.family === family && b.name === name)?.weaknesses ?? [];
  const planar = weaknesses("plant", "planar");
  const beam = weaknesses("sense", "single_beam");
  expect(planar.length).toBeGreaterThan(0);
  expect(beam.length).toBeGreaterThan(0);

  await openBench("lab", { "device.id": "lcr-350", "plant.model": "planar", "sensor.kind": "single_beam" });
  await page.getByRole("button", { name: /Recovery unit ?Single beam/ }).click();
  const card = page.getByRole("region", { name: "Block: Single beam, several hypotheses" });
  await expect(card.getByRole("note")).toHaveText(beam.map((text) => `Known weakness ${text}`));

  await page.getByRole("tab", { name: "Environment" }).click();
  for (const text of [...planar.slice(0, 1), ...beam]) {
    await expect(
      page
        .getByRole("note")
        .filter({ hasText: text.slice(0, 60) })
        .last(),
    ).toBeVisible();
  }
});

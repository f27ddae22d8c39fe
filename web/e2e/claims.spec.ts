import { readFile } from "node:fs/promises";
import { expect, front, test } from "./lab";

const NAME = "ch3-case1-aged-mass";
const QUOTE = "the controller generated almost 80% stronger signals than the input-reference";

test("a claim is judged on its bench and marked on the scope, its threshold is found, and it is kept as a slide", async ({
  page,
  server,
}) => {
  const { id } = await server.ask<{ id: string }>("POST", "/benches", { scenario: NAME, paused: true });
  await page.request.get(server.url);
  await page.goto(`${server.origin}/?bench=${id}&layout=lab`);
  await expect(page.getByTestId("bench-state")).toHaveText("paused");
  await front(page, "Voltage");
  await front(page, "Published");
  const claims = page.locator("section[aria-label='Claims']");
  const effort = (verdict: string) => claims.getByRole("listitem", { name: `effort ratio: ${verdict}` });
  await expect(claims).toHaveAttribute("data-over", "false");
  await expect(effort("not yet")).toBeVisible();
  await server.ask("POST", `/benches/${id}/commands`, { kind: "step", ticks: 10_000 });
  const held = effort("holds as printed");
  await expect(held).toBeVisible();
  for (const words of ["1.772", QUOTE, "figure 3.1.3.2.2", "reproduced by tuning"])
    await expect(held).toContainText(words);
  const scope = page.getByRole("region", { name: /^Scope: reference\.voltage/ });
  await expect(scope.getByText("figure 3.1.3.2.2", { exact: false })).toBeVisible();
  await scope.getByLabel("Printed").uncheck();
  await claims.getByLabel("Printed marks on the scopes").check();
  await expect(scope.getByLabel("Printed")).toBeChecked();

  await held.getByRole("button", { name: "Where does it hold?" }).click();
  await held.getByLabel("Turn").selectOption("events.1.severity");
  await held.getByRole("button", { name: "Find where it holds" }).click();
  // 1.71 to 1.89 times the reference: less than four weeks and more
  await expect(held.getByRole("img", { name: /holds from 3\.469 to 5\.475/ })).toBeVisible();
  const ageing = held.getByRole("textbox", { name: /Ageing/ });
  await ageing.fill("2");
  await ageing.press("Enter");
  await expect(held.getByText("does not hold")).toBeVisible();
  const severity = async () => {
    const bench = await server.ask<{ faults: { name: string; severity: number }[] }>("GET", `/benches/${id}`);
    return bench.faults.find(({ name }) => name === "ageing")?.severity;
  };
  await expect.poll(severity).toBe(2);
  await held.getByRole("button", { name: "Begin the bench again with it" }).click();
  await expect(claims).toHaveAttribute("data-over", "false");
  await server.ask("POST", `/benches/${id}/commands`, { kind: "step", ticks: 10_000 });
  const failed = effort("does not hold as printed");
  await expect(failed).toContainText("not reproduced");

  const keep = async (name: string) => {
    const [download] = await Promise.all([page.waitForEvent("download"), failed.getByRole("button", { name }).click()]);
    return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
  };
  const svg = await keep("SVG");
  expect(svg.name).toBe(`${NAME}-control-effort-ratio-slide.svg`);
  const text = svg.bytes.toString("utf-8").replaceAll(/<\/text>\s*<text[^>]*>/g, " ");
  for (const words of [QUOTE, "does not hold as printed", "not reproduced", "printed: 80%", "seed 1"])
    expect(text).toContain(words);
  const { bytes: png } = await keep("Slide PNG");
  expect([png.readUInt32BE(16), png.readUInt32BE(20)]).toEqual([1920, 1080]);
});

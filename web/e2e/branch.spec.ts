import { expect, test } from "./lab";
import { expectClean } from "./screens";

interface Bench {
  tick: number;
  state: string;
  controller: string;
  faults: { name: string }[];
  diagnosers: Record<string, { kind: string }>;
  origin: { bench: string; tick: number } | null;
}

test("one press: another controller from now, without the fault from now, another diagnoser for all that was", async ({
  page,
  server,
  openBench,
}) => {
  await openBench("lab", { samples: 1_000_000 });
  const shown = () => new URL(page.url()).searchParams.get("bench") ?? "";
  const ask = (id: string) => server.ask<Bench>("GET", `/benches/${id}`);
  const timeline = page.getByRole("region", { name: "Timeline" });
  const branch = timeline.getByRole("button", { name: "Branch here" });
  const lies = (bench: string) => expect(page.getByText(/^Behind, faded: /).first(), bench).toBeVisible();
  const bench = shown();
  await server.ask("POST", `/benches/${bench}/commands`, { fault: "added_mass", severity: 0.1 });
  const begun = (await ask(bench)).tick;
  await expect.poll(async () => (await ask(bench)).tick).toBeGreaterThan(begun + 100);

  await branch.click();
  await page.getByRole("menuitem", { name: "With PID" }).click();
  await expect.poll(shown).not.toBe(bench);
  const pid = shown();
  await expect.poll(async () => ask(pid)).toMatchObject({ controller: "pid", state: "running", origin: { bench } });
  await expect.poll(async () => (await ask(pid)).faults).toHaveLength(1);
  await lies("behind the PID");
  expect(await ask(bench)).toMatchObject({ state: "running" });

  await timeline.getByRole("button", { name: "The other future" }).click();
  await expect.poll(shown).toBe(bench);
  await branch.click();
  await page.getByRole("menuitem", { name: "Without added mass" }).click();
  await expect.poll(shown).not.toBe(bench);
  await expect.poll(async () => ask(shown())).toMatchObject({ faults: [], state: "running", origin: { bench } });

  await timeline.getByRole("button", { name: "The other future" }).click();
  await expect.poll(shown).toBe(bench);
  await branch.click();
  await expectClean(page, "the menu of branches");
  await page.getByRole("menuitem", { name: "With Consistency test" }).click();
  await expect.poll(shown).not.toBe(bench);
  const other = shown();
  await expect.poll(async () => (await ask(other)).state).toBe("running");
  const made = await ask(other);
  expect(Object.values(made.diagnosers).map(({ kind }) => kind)).toContain("consistency");
  expect(made.faults.map(({ name }) => name)).toEqual(["added_mass"]);
  await lies("behind the other diagnoser");
  const events = async (id: string) =>
    (await server.ask<{ events: { kind: string; tick: number }[] }>("GET", `/benches/${id}/events`)).events
      .filter(({ kind }) => kind === "inject")
      .map(({ tick }) => tick);
  expect(await events(other)).toEqual(await events(bench));
});

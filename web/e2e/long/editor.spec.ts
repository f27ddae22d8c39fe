import { readFileSync } from "node:fs";
import { join } from "node:path";
import { expect, test } from "../lab";
import { expectClean, expectReadable, SCHEMES, SCREENS, showOn } from "../screens";
import { seriousViolations } from "../serious-violations";

const DOCUMENT = readFileSync(join(import.meta.dirname, "..", "..", "..", "docs", "own-units.md"), "utf-8");
const PI = DOCUMENT.split("```python\n")[1].split("```")[0];

test("the editor and the difference of two versions fit on a large screen and on a phone, dark and light", async ({
  page,
  openBench,
}) => {
  await openBench();
  await page.keyboard.press("o");
  const editor = page.getByRole("region", { name: "Editor" });
  const text = editor.getByRole("textbox", { name: "Text of the unit" });
  const paste = async (source: string) => {
    await text.click();
    await page.keyboard.press("ControlOrMeta+a");
    await page.keyboard.insertText(source);
    await expect(editor.getByRole("status")).toContainText("It runs on this bench");
  };
  await paste(PI);
  for (const screen of [SCREENS[1], SCREENS[3]]) {
    await showOn(page, screen);
    await expect(text).toBeVisible();
    await expectClean(page, `the editor at ${screen.width}`);
    expect.soft(await seriousViolations(page)).toEqual([]);
    for (const scheme of SCHEMES) await expectReadable(page, `the editor at ${screen.width}`, scheme);
  }
  await showOn(page, SCREENS[1]);
  await paste(PI.replace('"PI"', '"PI of today"'));
  await editor.getByLabel("Version").selectOption({ index: 1 });
  await expect(editor.getByRole("region", { name: "Difference" })).toBeVisible();
  await expectClean(page, "the difference of two versions");
  expect.soft(await seriousViolations(page)).toEqual([]);
});

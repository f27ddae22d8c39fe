// Join a class with browsers of one's own and stay: `node students.mjs ORIGIN CODE COUNT SECONDS`.
// Says as JSON how long each took from the form to a moving trace, and how often its trace was still for a second.
import { setTimeout as wait } from "node:timers/promises";
import { chromium } from "@playwright/test";

const [origin, code, count, seconds] = process.argv.slice(2);
const TRACE = "section[aria-label^='Scope'] canvas";
const PHONE = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true };

/** What the trace shows, as text that can be compared. */
const pictureOf = (page) =>
  page
    .locator(TRACE)
    .first()
    .evaluate((canvas) => canvas.toDataURL());

/** Wait until the trace shows something else than it did. */
async function moved(page, from, withinMs) {
  const end = performance.now() + withinMs;
  while (performance.now() < end) {
    if ((await pictureOf(page)) !== from) return true;
    await wait(50);
  }
  return false;
}

async function student(number) {
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-gpu"],
  });
  const page = await (await browser.newContext(PHONE)).newPage();
  await page.goto(`${origin}/join?code=${code}`);
  await page.getByRole("textbox", { name: "Your name" }).fill(`Browser ${number}`);
  const began = performance.now();
  await page.getByRole("button", { name: "Join" }).click();
  await page.locator(TRACE).first().waitFor({ timeout: 60_000 });
  const joined = (await moved(page, await pictureOf(page), 60_000)) ? (performance.now() - began) / 1e3 : null;
  let stills = 0;
  for (const end = performance.now() + Number(seconds) * 1e3; performance.now() < end; await wait(5000))
    if (!(await moved(page, await pictureOf(page), 1000))) stills += 1;
  await browser.close();
  return { joined_s: joined, stills };
}

console.log(JSON.stringify(await Promise.all(Array.from({ length: Number(count) }, (_, i) => student(i + 1)))));

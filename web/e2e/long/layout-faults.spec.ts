import { expect, test } from "@playwright/test";
import { layoutFaults } from "../layout-faults";
import { SCREENS, showOn } from "../screens";

/** A page with one fault, and its description. */
const WRONG: [string, RegExp][] = [
  [`<div style="width: 500px; height: 10px"></div>`, /page is \d+ px wider/],
  [
    `<div style="width: 60px; overflow: hidden; white-space: nowrap">cut without a sign</div>`,
    /text .* is cut .* across/,
  ],
  [
    `<div style="display: flex; width: 60px; overflow: hidden; white-space: nowrap; text-overflow: ellipsis">cut without dots</div>`,
    /text .* is cut .* across/,
  ],
  [
    `<div style="width: 60px; overflow: hidden; white-space: nowrap; text-overflow: ellipsis"><p>cut without dots</p></div>`,
    /text .* is cut .* across/,
  ],
  [
    `<p style="width: 90px; height: 16px; overflow: hidden; -webkit-line-clamp: 1">two lines and no dots at their end</p>`,
    /is cut .* along/,
  ],
  [
    `<p style="display: -webkit-box; width: 90px; height: 24px; overflow: hidden; -webkit-box-orient: vertical; -webkit-line-clamp: 3">
      the dots are in a third line, which is below the edge</p>`,
    /is cut .* along/,
  ],
  [`<div style="height: 10px; overflow: hidden"><p style="margin: 0">only half as high</p></div>`, /is cut .* along/],
  [`<div style="width: 50px; overflow: hidden"><button style="width: 90px">Cut</button></div>`, /button "Cut" is cut/],
  [`<button style="position: fixed; bottom: -40px; height: 60px">Below</button>`, /button "Below" is cut .* along/],
  [
    `<p style="width: 12px; overflow: hidden; text-overflow: ellipsis; white-space: nowrap">next to nothing</p>`,
    /of "next to nothing" \d+ px are left/,
  ],
  [`<p style="margin: 0">first line</p><p style="margin: -12px 0 0">second line</p>`, /first line.* overlap/],
  [
    `<button style="height: 40px">Under</button><div style="position: absolute; inset: 0; height: 60px">over</div>`,
    /lies over button "Under"/,
  ],
  [`<button style="width: 30px; height: 30px; white-space: nowrap">far too long</button>`, /sticks out of its button/],
  [`<p style="font-size: 10px">small print</p>`, /"small print" is 10.0 px high/],
  [`<svg width="100" viewBox="0 0 200 20"><text y="15" font-size="14">scaled</text></svg>`, /"scaled" is 7.0 px high/],
  [`<button aria-label="Tiny" style="width: 18px; height: 18px"></button>`, /button "Tiny" is 18 x 26 px for a finger/],
  [
    `<section aria-label="Panel" style="width: 90px; overflow: auto"><div style="width: 200px">wide</div></section>`,
    /section "Panel" scrolls sideways/,
  ],
];

const RIGHT = `
  <h1>A page</h1>
  <div style="height: 60px; overflow: auto"><p>scrolled</p><p>to be</p><p>reached</p><button>Reach me</button></div>
  <p style="width: 90px; overflow: hidden; text-overflow: ellipsis; white-space: nowrap">cut with a sign of it</p>
  <p style="display: -webkit-box; width: 90px; overflow: hidden; -webkit-box-orient: vertical; -webkit-line-clamp: 2">
    cut with a sign of it at the end of its second line</p>
  <p style="width: 90px; overflow: hidden; text-overflow: ellipsis; white-space: nowrap"><b>cut</b> <i>with a sign of it</i></p>
  <div data-portal="true" style="position: absolute; top: 0; background: #fff">a menu over the page</div>`;

test("each fault of a page is found by itself, and nothing else is found", async ({ page }) => {
  await showOn(page, SCREENS[3]);
  const show = (html: string) =>
    page.setContent(
      `<meta name="viewport" content="width=device-width"><style>body { margin: 8px; font: 14px sans-serif } button { min-height: 26px }</style>${html}`,
    );
  await show(RIGHT);
  expect(await layoutFaults(page)).toEqual([]);
  for (const [html, said] of WRONG) {
    await show(html);
    expect(await layoutFaults(page), html).toEqual(expect.arrayContaining([expect.stringMatching(said)]));
  }
});

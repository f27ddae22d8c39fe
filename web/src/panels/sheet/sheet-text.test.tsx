import { renderToStaticMarkup } from "react-dom/server";
import { expect, test } from "vitest";
import { SheetText } from "./sheet-text";

const html = (text: string) => renderToStaticMarkup(<SheetText text={text} />);

test("mathematics is typeset, in a line and on lines of its own", () => {
  expect(html("The gain $k/m$ counts.")).toContain("katex");
  expect(html("Before\n\n$$x=1$$\n\nafter")).toContain("displaystyle");
});

test("HTML of a sheet stays text, pictures are left out, links run nothing", () => {
  const shown = html('A <script>alert(1)</script> <b onclick="x">b</b> ![p](http://a/b.png) [l](javascript:alert(1))');
  expect(shown).not.toMatch(/<script|<b |<img|javascript:/);
  expect(shown).toContain("alert(1)");
});

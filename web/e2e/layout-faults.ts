import type { Page } from "@playwright/test";

/**
 * Faults in the layout of a page or a part of it, one line each: parts that are cut, out of reach, over another part,
 * or too small to read or, on a touch screen, to hit.
 *
 * It does not see the drawing on a canvas.
 */
export const layoutFaults = (page: Page, within = "body"): Promise<string[]> => page.evaluate(findFaults, within);

/** The same in either scheme, in one visit to the page. */
export const faultsInBothSchemes = (page: Page, within = "body"): Promise<string[]> =>
  page.evaluate(`(${inBothSchemes})(${findFaults}, ${JSON.stringify(within)})`);

function inBothSchemes(find: (within: string) => string[], within: string): string[] {
  const name = "data-mantine-color-scheme";
  const now = document.documentElement.getAttribute(name) ?? "light";
  const other = now === "dark" ? "light" : "dark";
  return [other, now].flatMap((scheme) => {
    document.documentElement.setAttribute(name, scheme);
    return find(within).map((fault) => `${scheme}: ${fault}`);
  });
}

/** Runs in the page, so it holds all it needs. */
function findFaults(within: string): string[] {
  interface Box {
    left: number;
    top: number;
    right: number;
    bottom: number;
  }
  interface Text {
    node: Element;
    says: string;
    box: Box;
  }
  const SMALLEST_TYPE = 10.99;
  const SMALLEST_TARGET = 23.5;
  /** Letters fill less than the box of their line. */
  const LEADING = 0.35;
  const CONTROLS = "button, a[href], input, select, textarea, summary, [role=tab], [role=slider], [role=menuitem]";

  const found = new Set<string>();
  const roots = Array.from(document.querySelectorAll(within));
  const name = (e: Element) =>
    `${e.tagName.toLowerCase()} "${(e.getAttribute("aria-label") ?? e.textContent ?? "").trim().slice(0, 40)}"`;
  const touch = matchMedia("(pointer: coarse)").matches;
  const styles = new Map<Element, CSSStyleDeclaration>();
  const styleOf = (e: Element) => {
    const known = styles.get(e) ?? getComputedStyle(e);
    styles.set(e, known);
    return known;
  };
  const boxes = new Map<Element, DOMRect>();
  const boxOf = (e: Element) => {
    const known = boxes.get(e) ?? e.getBoundingClientRect();
    boxes.set(e, known);
    return known;
  };
  const shown = (e: Element) => e.checkVisibility({ opacityProperty: true, visibilityProperty: true });
  /** For screen readers only. */
  const hidden = new Map<Element, boolean>();
  const unseen = (e: Element): boolean => {
    const known = hidden.get(e);
    if (known !== undefined) return known;
    const is: boolean =
      e.matches(".katex-mathml, [aria-hidden=true]") ||
      (e.clientWidth === 1 && e.clientHeight === 1) ||
      (e.parentElement !== null && unseen(e.parentElement));
    hidden.set(e, is);
    return is;
  };
  /** Whether a text that is too wide for a box ends in dots: a block or a flex item in it would have no dots. */
  const hasDots = (e: Element, box: Element) => {
    let own: Element | null = e;
    while (own && own !== box && /^(inline|contents)/.test(styleOf(own).display)) own = own.parentElement;
    return styleOf(box).textOverflow === "ellipsis" && own === box && !/flex|grid/.test(styleOf(box).display);
  };
  /** Whether a box shows all the lines that it may have, and ends in dots. */
  const endsInDots = (e: Element) => {
    const { display, fontSize, lineHeight, webkitLineClamp } = styleOf(e);
    const line = Number.parseFloat(lineHeight) || 1.2 * Number.parseFloat(fontSize);
    return /box|flow-root/.test(display) && boxOf(e).height > (Number(webkitLineClamp) - LEADING) * line;
  };
  /** Menus and dialogs are meant to cover the page. */
  const layer = (e: Element) => e.closest("[data-portal], [role=dialog], [role=menu]");

  /** The part of a box that hiding ancestors cut off, where nothing between scrolls to it; and the visible part. */
  const clip = (e: Element, box: Box) => {
    const seen = { left: box.left, top: box.top, right: box.right, bottom: box.bottom };
    const reach = { ...seen };
    let across = 0;
    let along = 0;
    let ellipsis = false;
    let up: Element | null = e;
    let absolute = false;
    for (; up; up = up.parentElement) {
      const style = styleOf(up);
      const holds = !absolute || style.position !== "static";
      if (holds) absolute = false;
      if (holds && style.overflowX !== "visible" && style.display !== "inline") {
        const edge = boxOf(up);
        if (/auto|scroll/.test(style.overflowX) || up.matches("[role=tablist]")) {
          reach.left = Math.max(reach.left, edge.left);
          reach.right = Math.min(reach.right, edge.right);
        } else {
          const over = Math.max(edge.left - reach.left, reach.right - edge.right);
          if (hasDots(e, up) || up.matches("input, select")) ellipsis ||= over > 0;
          else across = Math.max(across, over);
        }
        if (/auto|scroll/.test(style.overflowY)) {
          reach.top = Math.max(reach.top, edge.top);
          reach.bottom = Math.min(reach.bottom, edge.bottom);
        } else {
          if (endsInDots(up)) reach.bottom = Math.min(reach.bottom, edge.bottom);
          along = Math.max(along, edge.top - reach.top, reach.bottom - edge.bottom);
        }
        seen.left = Math.max(seen.left, edge.left);
        seen.right = Math.min(seen.right, edge.right);
        seen.top = Math.max(seen.top, edge.top);
        seen.bottom = Math.min(seen.bottom, edge.bottom);
      }
      if (style.position === "fixed") break;
      if (style.position === "absolute") absolute = true;
    }
    across = Math.max(across, -reach.left, reach.right - window.innerWidth);
    along = Math.max(along, -reach.top, reach.bottom - window.innerHeight);
    return { across, along, ellipsis, seen };
  };
  const whole = (seen: Box, box: Box) =>
    seen.right - seen.left >= box.right - box.left - 1 && seen.bottom - seen.top >= box.bottom - box.top - 1;

  /** Whether an opaque element covers an element at a point. */
  const covered = (e: Element, x: number, y: number) => {
    for (const top of document.elementsFromPoint(x, y)) {
      if (top.contains(e) || e.contains(top)) return false;
      const [, , , alpha = "1"] = styleOf(top).backgroundColor.match(/[\d.]+/g) ?? [];
      if (Number(alpha) === 1) return true;
    }
    return false;
  };

  const wide = document.documentElement.scrollWidth - window.innerWidth;
  if (wide > 0) found.add(`the page is ${wide} px wider than its window`);

  const texts: Text[] = [];
  for (const root of roots) {
    for (const e of Array.from(root.querySelectorAll(CONTROLS))) {
      if (!shown(e) || unseen(e)) continue;
      const box = e.getBoundingClientRect();
      if (box.width < 2 || box.height < 2) continue;
      const { across, along, seen } = clip(e.parentElement ?? e, box);
      if (across > 1.5 && !e.matches("[role=tab]")) found.add(`${name(e)} is cut by ${Math.round(across)} px across`);
      if (along > 1.5) found.add(`${name(e)} is cut by ${Math.round(along)} px along`);
      const inline = e.tagName === "A" && styleOf(e).display === "inline";
      const label = (e as HTMLInputElement).labels?.[0];
      const target = (e.closest("label, .mantine-Input-wrapper") ?? e).getBoundingClientRect();
      const width = Math.max(target.width, label?.offsetWidth ?? 0);
      const height = Math.max(target.height, label?.offsetHeight ?? 0);
      if (touch && !inline && !e.matches(":disabled") && Math.min(width, height) < SMALLEST_TARGET)
        found.add(`${name(e)} is ${Math.round(width)} x ${Math.round(height)} px for a finger`);
      if (!whole(seen, box)) continue;
      for (const at of [0.25, 0.5, 0.75]) {
        const x = box.left + at * box.width;
        const y = (box.top + box.bottom) / 2;
        const top = document.elementFromPoint(x, y);
        if (!top || e.contains(top) || top.contains(e) || top.closest("label")?.contains(e)) continue;
        if (layer(top) && layer(top) !== layer(e)) continue;
        found.add(`${name(top)} lies over ${name(e)}`);
        break;
      }
    }
    const walk = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
    for (let node = walk.nextNode(); node; node = walk.nextNode()) {
      const e = node.parentElement;
      const says = node.textContent?.trim().slice(0, 40) ?? "";
      if (!e || !says || e.matches("option, style, script, title, desc") || !shown(e) || unseen(e)) continue;
      const formula = e.closest(".katex") !== null;
      const drawn = e instanceof SVGGraphicsElement ? e.getScreenCTM() : null;
      const scale = drawn ? Math.sqrt(Math.abs(drawn.a * drawn.d - drawn.b * drawn.c)) : 1;
      const size = Number.parseFloat(styleOf(e).fontSize) * scale;
      if (!formula && size < SMALLEST_TYPE) found.add(`"${says}" is ${size.toFixed(1)} px high`);
      const range = document.createRange();
      range.selectNodeContents(node);
      for (const box of Array.from(range.getClientRects())) {
        if (box.width < 1 || box.height < 1) continue;
        const { across, along, ellipsis, seen } = clip(e, box);
        if (across > 1.5) found.add(`text "${says}" is cut by ${Math.round(across)} px across`);
        if (along > LEADING * box.height) found.add(`text "${says}" is cut by ${Math.round(along)} px along`);
        if (ellipsis && seen.right - seen.left < 3 * size && box.width > 3 * size)
          found.add(`of "${says}" ${Math.round(seen.right - seen.left)} px are left`);
        const button = e.closest("button");
        const edge = button?.getBoundingClientRect();
        if (edge && !ellipsis && (box.right > edge.right + 1 || box.left < edge.left - 1))
          found.add(`text "${says}" sticks out of its button`);
        if (formula || seen.right - seen.left < 1 || seen.bottom - seen.top < 1) continue;
        const inset = (LEADING / 2) * box.height;
        texts.push({ node: e, says, box: { ...seen, top: seen.top + inset, bottom: seen.bottom - inset } });
      }
    }
  }
  texts.sort((a, b) => a.box.top - b.box.top);
  texts.forEach((a, i) => {
    for (const b of texts.slice(i + 1)) {
      if (b.box.top > a.box.bottom) break;
      const left = Math.max(a.box.left, b.box.left);
      const right = Math.min(a.box.right, b.box.right);
      const bottom = Math.min(a.box.bottom, b.box.bottom);
      if (a.node === b.node || right - left < 2 || bottom - b.box.top < 1) continue;
      const [x, y] = [(left + right) / 2, (b.box.top + bottom) / 2];
      if (!covered(a.node, x, y) && !covered(b.node, x, y)) found.add(`text "${a.says}" and "${b.says}" overlap`);
    }
  });
  // an element that is wider than any window may scroll in a place of its own, a panel as a whole may not
  for (const e of roots.flatMap((root) => Array.from(root.querySelectorAll("*")))) {
    const over = e.scrollWidth - e.clientWidth;
    if (over <= 1 || e.clientWidth === 0 || !/auto|scroll/.test(styleOf(e).overflowX) || !shown(e)) continue;
    if (!e.matches("[role=tablist], input, textarea, :has(> table, > .katex, > .katex-display, > svg)"))
      found.add(`${name(e)} scrolls sideways by ${over} px`);
  }
  return [...found];
}

/** The pages, each with its path below the root of the server. */
const PATHS = {
  bench: "",
  class: "class",
  gallery: "gallery",
  runs: "runs",
  benchmark: "scores",
  designer: "design",
  theory: "theory",
} as const;

export type PageName = keyof typeof PATHS;

const PAGE_NAMES = Object.keys(PATHS) as PageName[];

/** Pages that show one thing of many: an experiment, runs by their ids, a device, equations by their words. */
const WITH_ITEM: PageName[] = ["gallery", "runs", "designer", "theory"];

/** A page, and the one thing that it shows of many, if any. */
export interface Place {
  page: PageName;
  item: string;
}

/** Names in the query by which addresses of earlier versions say the same. */
export const EARLIER = ["page", "compare", "sweep", "run"];

/** Where a learning platform opens the page. */
const LAUNCH = "lti";

/** The place of an address; nothing where there is none. */
export function placeOf({ pathname, searchParams }: URL): Place | undefined {
  const path = pathname.slice(new URL("./", document.baseURI).pathname.length);
  if (path === "" || path === LAUNCH) return earlierPlace(searchParams);
  const [, name, item] = /^([a-z]+)(?:\/([^/]+))?$/.exec(path) ?? [];
  const page = PAGE_NAMES.find((one) => one !== "bench" && PATHS[one] === name);
  if (!page || (item && !WITH_ITEM.includes(page))) return undefined;
  return { page, item: decoded(item ?? "") };
}

/** The address of a place in full, to be passed on. */
export function addressOf({ page, item }: Place): string {
  const path = item ? `${PATHS[page]}/${encodeURIComponent(item).replaceAll("%2C", ",")}` : PATHS[page];
  return new URL(`./${path}`, document.baseURI).href;
}

function earlierPlace(query: URLSearchParams): Place {
  const page = PAGE_NAMES.find((one) => one === query.get("page")) ?? "bench";
  const item = page === "runs" ? (query.get("compare") ?? query.get("sweep") ?? query.get("run")) : "";
  return { page, item: item ?? "" };
}

function decoded(item: string): string {
  try {
    return decodeURIComponent(item);
  } catch {
    return item; // a lone % is one
  }
}

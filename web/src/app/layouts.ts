import type { DockviewApi, SerializedDockview } from "dockview-react";
import { api } from "../api/api";
import { hasAxes } from "../api/fits";
import { storageName } from "../api/storage-name";
import { bringBack, dockNow, forgetClosed, inFront, restoreLayout, type SharedLayout, useDock } from "../bench/dock";
import { inAddress } from "../bench/open-bench";
import type { PanelName } from "../bench/panel-views";
import { showError } from "../bench/send";
import { chooseLayout, type LayoutName, useView } from "../bench/view-store";
import { useBench } from "../stream/bench-store";
import { BUILT_IN, BUILT_IN_RECORD, THREE_COLUMNS_PX } from "./built-in-layouts";
import { layoutHistory } from "./layout-history";
import { PANELS } from "./panels";
import { BUILT_IN_AXES } from "./two-axis-layouts";

/** A layout of the user: its name, and whether it is in large type. */
interface OwnLayout {
  name: string;
  large: boolean;
}

/** The layout that came with a link; the next one takes its place unless it is saved under a name. */
export const FROM_LINK = "from a link";
/** The layout that the teacher gave to all. */
export const FROM_TEACHER = "from your teacher";
/** The layout of a cue of a lecture, or of a step of a tour; it goes when that is left. */
const FROM_SCRIPT = "from a script";
const LONGEST_NAME = 40;
/** The least width of a panel, px. */
const LEAST_PX = 240;
/** The id of a link. */
const LINK = /^[2-9a-z]{8}$/;

/** Whether the layout is for a bench with axes. */
let axes = false;
/** Whether it is for a record of a device. */
let record = false;
/** Whether the dock has room for a third column; a built-in layout is kept for either case. */
let wide = true;
/** A layout that came before there was a dock to show it in. */
let coming: { shared: SharedLayout; name: string } | undefined;

const kind = () => (axes ? "axes." : "");
const LIST = () => storageName(`combbench.layouts.${kind()}own`);
const ofBench = () => (record && !axes ? "record." : kind());
const room = () => (wide ? "" : "narrow.");
const storageKey = (name: string) =>
  storageName(`combbench.layout.4.${isBuiltIn(name) ? ofBench() + room() : `${kind()}own.`}${name}`);

export const isBuiltIn = (name: string): name is LayoutName => name in BUILT_IN;

/** The user's own layouts for the kind of bench on the page. */
export const ownLayouts = (): OwnLayout[] => JSON.parse(localStorage.getItem(LIST()) ?? "[]") as OwnLayout[];

/** A name, if there is such a layout for the kind of bench on the page. */
const known = (name: string | undefined): string | undefined =>
  name && (isBuiltIn(name) || ownLayouts().some((own) => own.name === name) || stored(name)) ? name : undefined;

const keepList = (layouts: OwnLayout[]) => localStorage.setItem(LIST(), JSON.stringify(layouts));

/** Lay the panels out for the benches of a kind; within one kind they keep their places. */
export function layOutFor(withAxes: boolean, ofRecord: boolean): void {
  if (withAxes === axes && ofRecord === record) return;
  axes = withAxes;
  record = ofRecord;
  arrange(known(inAddress("layout")) ?? known(useView.getState().layout) ?? "lab");
  layoutHistory.forget();
}

/** Set the dock to lay out, once it exists. A panel without a title gets the title of its kind. */
export function attachDock(api: DockviewApi): void {
  useDock.setState({ dock: api });
  api.onDidAddGroup((group) => {
    group.api.setConstraints({ minimumWidth: LEAST_PX });
    group.api.onDidDimensionsChange(() => queueMicrotask(fitColumns)); // the dock is in the middle of its own work
  });
  api.onDidAddPanel((panel) => {
    if (!panel.title || panel.title === panel.id)
      panel.api.setTitle(PANELS[panel.view.contentComponent as PanelName].title);
  });
  const { bench } = useBench.getState();
  axes = hasAxes(bench);
  record = Boolean(bench?.record);
  const asked = inAddress("layout");
  arrange(known(asked) ?? known(useView.getState().layout) ?? "lecture");
  layoutHistory.watch(api);
  api.onDidLayoutChange(keepLayout);
  if (coming) showNext(coming.shared, coming.name);
  else if (asked && !known(asked) && LINK.test(asked)) fetchLayout(asked).catch(showError);
}

/** A dock that is not on the page yet has no width. */
const widthOf = (api: DockviewApi): number => api.width || window.innerWidth;

const isWide = (api: DockviewApi): boolean => widthOf(api) >= THREE_COLUMNS_PX;

/**
 * Lay a built-in layout out as it is kept for as many columns as the dock has room for now.
 *
 * The views in front stay there, and each panel keeps its settings, such as the trigger of a scope.
 */
function fitColumns(): void {
  const api = dockNow();
  const { layout } = useView.getState();
  if (!api?.width || isWide(api) === wide || !isBuiltIn(layout)) return;
  const front = inFront();
  const settings = api.panels.map(({ id, params }) => ({ id, params }));
  arrange(layout);
  for (const { id, params } of settings) if (params) api.getPanel(id)?.api.updateParameters(params);
  bringBack(front);
}

/** Remember the layout with the settings of each panel. */
export function keepLayout(): void {
  const dock = dockNow();
  if (dock) localStorage.setItem(storageKey(useView.getState().layout), JSON.stringify(dock.toJSON()));
}

/** Choose a layout as it was left. The address names it. */
export function setLayout(name: string): void {
  arrange(name);
  chooseLayout(name);
}

/** Lay the panels out as a built-in layout has them at first; the layouts that are kept stay as they are. */
export function layOutForScript(name: LayoutName): void {
  localStorage.removeItem(storageKey(FROM_SCRIPT));
  arrange(FROM_SCRIPT, name === "lecture", name);
}

/** Reset a built-in layout to its first state. */
export function resetLayout(): void {
  const name = useView.getState().layout;
  localStorage.removeItem(storageKey(name));
  arrange(name);
}

/** Why a layout cannot have a name; nothing if it can. */
export function refusal(name: string): string | undefined {
  const plain = name.trim().toLowerCase();
  if (!plain) return "Give it a name.";
  if (plain.length > LONGEST_NAME) return `A name has at most ${LONGEST_NAME} characters.`;
  if (
    [...Object.keys(BUILT_IN), FROM_LINK, FROM_TEACHER, FROM_SCRIPT, ...ownLayouts().map((own) => own.name)].some(
      (n) => n.toLowerCase() === plain,
    )
  )
    return "There is a layout of this name.";
  return undefined;
}

/** Save the present layout under a name; later changes are saved there too. */
export function saveLayout(name: string, large = useView.getState().large): void {
  keepList([...ownLayouts(), { name, large }]);
  useView.setState({ layout: name });
  keepLayout();
  chooseLayout(name);
}

export function renameLayout(name: string, next: string): void {
  const kept = localStorage.getItem(storageKey(name));
  keepList(ownLayouts().map((own) => (own.name === name ? { ...own, name: next } : own)));
  if (kept) localStorage.setItem(storageKey(next), kept);
  localStorage.removeItem(storageKey(name));
  if (useView.getState().layout !== name) return;
  useView.setState({ layout: next });
  chooseLayout(next);
}

export function deleteLayout(name: string): void {
  if (useView.getState().layout === name) setLayout("lab");
  keepList(ownLayouts().filter((own) => own.name !== name));
  localStorage.removeItem(storageKey(name));
}

/** The present layout, to be shared. */
export function sharedLayout(): SharedLayout | undefined {
  const dock = dockNow()?.toJSON();
  return dock && { dock, large: useView.getState().large, axes };
}

/** Show a layout that came with a link. */
export const showShared = (shared: SharedLayout): void => showNext(shared, FROM_LINK);

/** Show a layout that the teacher gave to all. */
export const showGiven = (shared: SharedLayout): void => showNext(shared, FROM_TEACHER);

function showNext(shared: SharedLayout, name: string): void {
  coming = dockNow() ? undefined : { shared, name };
  if (!coming) show(shared, name);
}

/** Show the layout of a link, and keep it under its name, with a number if the name is taken. */
async function fetchLayout(link: string): Promise<void> {
  const { title, content } = await api.link(link);
  if (!content.layout) return;
  const shared = content.layout as unknown as SharedLayout;
  axes = shared.axes;
  let name = title.slice(0, LONGEST_NAME - 4);
  for (let n = 2; refusal(name); n += 1) name = `${title.slice(0, LONGEST_NAME - 4)} ${n}`;
  show(shared, name);
  saveLayout(name, shared.large);
}

/** Put the panels as they stood in a layout. */
export function putLayout(name: string, dock: SerializedDockview, large?: boolean): void {
  localStorage.setItem(storageKey(name), JSON.stringify(dock));
  arrange(name, large);
  chooseLayout(name);
}

function show(shared: SharedLayout, name: string): void {
  axes = shared.axes;
  putLayout(name, shared.dock, shared.large);
}

function stored(name: string): SerializedDockview | undefined {
  const text = localStorage.getItem(storageKey(name));
  return text ? (JSON.parse(text) as SerializedDockview) : undefined;
}

function arrange(
  name: string,
  large = ownLayouts().find((own) => own.name === name)?.large ?? name === "lecture",
  like: string = name,
): void {
  const api = dockNow();
  useView.setState({ layout: name, large });
  if (!api) return;
  wide = isWide(api);
  forgetClosed();
  const saved = stored(name);
  if (saved && restoreLayout(saved)) return;
  localStorage.removeItem(storageKey(name));
  api.clear();
  const layouts = axes ? BUILT_IN_AXES : record ? BUILT_IN_RECORD : BUILT_IN;
  layouts[isBuiltIn(like) ? like : "lab"](api, widthOf(api), api.height || window.innerHeight);
}

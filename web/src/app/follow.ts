import { notifications } from "@mantine/notifications";
import { create } from "zustand";
import { api } from "../api/api";
import { askMe, givenLayout, placeOf, useMe } from "../api/me";
import { sheets } from "../api/sheets";
import { storageName } from "../api/storage-name";
import type { SharedLayout } from "../bench/dock";
import { openBench } from "../bench/open-bench";
import { setPage, useView } from "../bench/view-store";
import { showSheet } from "../panels/sheet/begin";
import { isBuiltIn, setLayout, showGiven } from "./layouts";

const TAKEN = storageName("combbench.layout.given");

/** The layout that the teacher has given to this page, and the layout before it. */
export const useGiven = create<{ given: { name: string; before: string } | undefined }>(() => ({ given: undefined }));

/** Ask which bench the person at this page sees and drives now, and go there. */
export async function follow(): Promise<void> {
  const { me: before, at } = useMe.getState();
  const me = await askMe();
  const to = placeOf(me, before, at);
  if (to && to !== useMe.getState().at) {
    if (to !== me.bench) setPage("bench");
    openBench(to, true);
    if (before?.bench && at === before.bench && to === me.bench) {
      const { title } = await api.bench(to);
      notifications.show({
        title: "You have a new bench",
        message: `${title} has begun in place of your bench before.`,
      });
    }
  }
  if (to && to === me.bench && me.role === "student") await showSheetOf(to);
  if (me.layout && me.layout !== localStorage.getItem(TAKEN)) await takeLayout();
}

/** Show the sheet that a bench was begun for, if it was. */
async function showSheetOf(bench: string): Promise<void> {
  const { current } = await sheets.all();
  if (current && (await sheets.get(current)).bench === bench) showSheet();
}

/** Arrange the panels as the teacher says, once, and keep the layout from before. A phone has no panels to arrange. */
async function takeLayout(): Promise<void> {
  if (window.innerWidth <= 600) return;
  const { id, name, layout } = await givenLayout();
  const before = useGiven.getState().given?.before ?? useView.getState().layout;
  localStorage.setItem(TAKEN, id);
  if (layout) showGiven(layout as unknown as SharedLayout);
  else if (isBuiltIn(name)) setLayout(name);
  useGiven.setState({ given: { name, before } });
}

/** Arrange the panels as they were before the teacher gave a layout. */
export function leaveGiven(): void {
  const { given } = useGiven.getState();
  if (given) setLayout(given.before);
  useGiven.setState({ given: undefined });
}

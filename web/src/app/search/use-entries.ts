import { useMemo } from "react";
import { useShallow } from "zustand/react/shallow";
import { api } from "../../api/api";
import { useMe, useServed } from "../../api/me";
import { useAnswer } from "../../api/queries";
import { useCatalog } from "../../api/use-catalog";
import { addPanel, showPanel, useDock } from "../../bench/dock";
import { hasSeveral, type ViewName } from "../../bench/panel-views";
import type { PageName } from "../../bench/places";
import { openPlace, setPage, useView } from "../../bench/view-store";
import { useInstances } from "../../panels/card/instances";
import { parameterTitle } from "../../panels/card/parameter-title";
import { useBench } from "../../stream/bench-store";
import { entriesOf } from "../../theory/equations";
import { isOffered, PAGES } from "../pages";
import { VIEW } from "../panels";
import { viewEntries } from "../view-entries";
import type { Entry } from "./find";

/** All that can be found on the page of a person. */
export function useEntries(): Entry[] {
  const role = useMe((s) => s.me?.role);
  const served = useServed();
  const axes = useBench(useShallow((s) => s.bench?.axes));
  const instances = useInstances();
  const { blocks, block } = useCatalog();
  const { value: scenarios } = useAnswer(["scenarios"], api.scenarios);
  const { value: catalogue } = useAnswer(["device catalogue"], api.deviceCatalogue);
  const equations = useMemo(() => entriesOf(blocks), [blocks]);
  const bench = axes && { axes };
  const places = (Object.keys(PAGES) as PageName[]).filter((page) => isOffered(page, role));
  return [
    ...places.map((page): Entry => {
      const { name, title } = PAGES[page];
      return { group: "Places", key: page, title: name, about: title, open: () => setPage(page) };
    }),
    ...viewEntries(bench).map(
      ({ panel, view, title, about }): Entry => ({
        group: "Panels",
        key: view,
        title,
        about,
        words: VIEW[view].title,
        open: () => openView(view, hasSeveral(panel)),
      }),
    ),
    ...(served ? (scenarios ?? []) : []).map(
      ({ id, title }): Entry => ({
        group: "Scenarios",
        key: id,
        title: title,
        about: id,
        open: () => openPlace("gallery", id),
      }),
    ),
    ...(served ? (catalogue?.devices ?? []) : []).map(
      ({ id, title, source }): Entry => ({
        group: "Devices",
        key: id,
        title: title || id,
        about: source || id,
        words: id,
        open: () => openPlace("designer", id),
      }),
    ),
    ...instances.flatMap(({ id, family, name }) => {
      const card = block(family, name);
      return (card?.parameters ?? []).map(
        (parameter): Entry => ({
          group: "Settings",
          key: `${id}.${parameter.name}`,
          title: parameterTitle(parameter),
          about: card?.title ?? name,
          words: `${id}.${parameter.name}`,
          open: () => {
            useView.setState({ card: id });
            openView("card");
          },
        }),
      );
    }),
    ...(served ? equations : []).map(({ family, blocks: of, equation: { label, latex, source }, words }): Entry => {
      const title = `${of[0]} ${label.replaceAll("_", " ")}`;
      return {
        group: "Equations",
        key: `${family} ${title} ${latex}`,
        title,
        about: source,
        words,
        open: () => openPlace("theory", title),
      };
    }),
  ];
}

/** Bring a view of a panel to the front; from another page after the dock has opened. */
function openView(view: ViewName, another = false): void {
  const show = () => {
    if (another) addPanel(view);
    else showPanel(view);
  };
  if (useView.getState().page === "bench") {
    show();
    return;
  }
  const stop = useDock.subscribe((now, before) => {
    if (now.dock === before.dock) return;
    stop();
    queueMicrotask(show); // after the layout
  });
  useView.setState({ extra: view });
  setPage("bench");
}

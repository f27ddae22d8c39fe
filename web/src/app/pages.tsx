import {
  IconChartHistogram,
  IconLayoutDashboard,
  IconMathFunction,
  IconPhoto,
  IconRulerMeasure,
} from "@tabler/icons-react";
import type { ComponentType, ReactNode } from "react";
import type { PageName } from "../bench/view-store";
import { Designer } from "../designer/designer";
import { GalleryPage } from "../gallery/gallery-page";
import { RunsPage } from "../runs/runs-page";
import { Theory } from "../theory/theory";
import { Workspace } from "./workspace";

export interface PageKind {
  /** One word, under the icon. */
  name: string;
  title: string;
  icon: ReactNode;
  key: string;
  component: ComponentType;
}

const ICON = 21;

/** Every page; a new one is its folder, its name in the view store and an entry here. */
export const PAGES: Record<PageName, PageKind> = {
  bench: {
    name: "Bench",
    title: "The live bench",
    icon: <IconLayoutDashboard size={ICON} />,
    key: "b",
    component: Workspace,
  },
  gallery: {
    name: "Gallery",
    title: "Gallery: every experiment with its claim and its measurement",
    icon: <IconPhoto size={ICON} />,
    key: "e",
    component: GalleryPage,
  },
  runs: {
    name: "Runs",
    title: "Headless runs and campaigns",
    icon: <IconChartHistogram size={ICON} />,
    key: "u",
    component: RunsPage,
  },
  designer: {
    name: "Design",
    title: "Device designer",
    icon: <IconRulerMeasure size={ICON} />,
    key: "g",
    component: Designer,
  },
  theory: {
    name: "Theory",
    title: "Theory: stability, excitation and all equations",
    icon: <IconMathFunction size={ICON} />,
    key: "t",
    component: Theory,
  },
};

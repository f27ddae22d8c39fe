import {
  IconChartHistogram,
  IconLayoutDashboard,
  IconMathFunction,
  IconPhoto,
  IconRulerMeasure,
  IconSchool,
} from "@tabler/icons-react";
import type { ComponentType, ReactNode } from "react";
import { may, type Right, type Role } from "../api/me";
import type { PageName } from "../bench/places";
import { ClassPage } from "../class/class-page";
import { Designer } from "../designer/designer";
import { GalleryPage } from "../gallery/gallery-page";
import { Runs } from "../runs/runs";
import { Theory } from "../theory/theory";
import { Workspace } from "./workspace";

interface PageKind {
  /** One word, under the icon. */
  name: string;
  title: string;
  icon: ReactNode;
  key: string;
  /** The right that the page needs. */
  needs?: Right;
  /** The page whose tab it is. */
  tabOf?: PageName;
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
  class: {
    name: "Class",
    title: "Class: students who join by a code, each with a bench of their own",
    icon: <IconSchool size={ICON} />,
    key: "m",
    needs: "teach",
    component: ClassPage,
  },
  gallery: {
    name: "Gallery",
    title: "Gallery: every experiment with its claim and its measurement",
    icon: <IconPhoto size={ICON} />,
    key: "e",
    needs: "server",
    component: GalleryPage,
  },
  runs: {
    name: "Runs",
    title: "Headless runs, campaigns, and the scores of the diagnosers",
    icon: <IconChartHistogram size={ICON} />,
    key: "u",
    needs: "server",
    component: Runs,
  },
  benchmark: {
    name: "Scores",
    title: "Scores of the diagnosers on public cases",
    icon: <IconChartHistogram size={ICON} />,
    key: "j",
    needs: "server",
    tabOf: "runs",
    component: Runs,
  },
  designer: {
    name: "Design",
    title: "Device designer",
    icon: <IconRulerMeasure size={ICON} />,
    key: "g",
    needs: "server",
    component: Designer,
  },
  theory: {
    name: "Theory",
    title: "Theory: stability, excitation and all equations",
    icon: <IconMathFunction size={ICON} />,
    key: "t",
    needs: "server",
    component: Theory,
  },
};

/** Whether a page is offered to a role. */
export const isOffered = (page: PageName, role: Role | undefined): boolean => {
  const { needs } = PAGES[page];
  return !needs || (role ? may(needs, role) : needs === "server"); // an unknown person has a server
};

import {
  IconChartHistogram,
  IconLayoutDashboard,
  IconListNumbers,
  IconMathFunction,
  IconPhoto,
  IconRulerMeasure,
  IconSchool,
} from "@tabler/icons-react";
import type { ComponentType, ReactNode } from "react";
import { may, type Right } from "../api/me";
import type { Me } from "../api/types";
import type { PageName } from "../bench/places";
import { BenchmarkPage } from "../benchmark/benchmark-page";
import { ClassPage } from "../class/class-page";
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
  /** What one must be allowed for the page to be there. */
  needs?: Right;
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
    component: GalleryPage,
  },
  runs: {
    name: "Runs",
    title: "Headless runs and campaigns",
    icon: <IconChartHistogram size={ICON} />,
    key: "u",
    needs: "teach",
    component: RunsPage,
  },
  benchmark: {
    name: "Scores",
    title: "Benchmark: how soon and how honestly diagnosers notice a fault",
    icon: <IconListNumbers size={ICON} />,
    key: "j",
    component: BenchmarkPage,
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

/** Whether a page is there for somebody. */
export const isOffered = (page: PageName, role: Me["role"] | undefined): boolean => {
  const { needs } = PAGES[page];
  return !needs || may(needs, role);
};

import { useState } from "react";
import { api } from "../api/api";
import { type Answer, useAnswer, useLast } from "../api/queries";
import type { PointQuery, SweepPoints, SweepRun } from "../api/types";
import { isActive } from "./jobs";

/** Points that the page has all at once; more are read page by page, in the order the server sorts them. */
const MOST = 200;
/** Points of a page. */
export const PAGE = 50;

const BUSY_MS = 2000;
/** Until the first result has arrived. */
const FIRST_MS = 200;

/** The sort order of a table of points. */
interface Order {
  id: string;
  down: boolean;
}

export interface Points extends Omit<Answer<SweepPoints>, "value"> {
  value: SweepPoints | undefined;
  /** Whether the points are one page of many. */
  isPage: boolean;
  /** The first is 1. */
  page: number;
  setPage(page: number): void;
  order: Order | undefined;
  setOrder(order: Order): void;
  /** When results are asked for again, ms. */
  every: number | undefined;
}

/** The points of a campaign that have results: all of a small one, a page of a large one. */
export function usePoints(sweep: SweepRun): Points {
  const active = isActive(sweep.state);
  const [page, setPage] = useState(1);
  const [order, setOrder] = useState<Order | undefined>(undefined);
  const [found, setFound] = useState(0);
  const isPage = found > MOST;
  const query: PointQuery = isPage
    ? { limit: PAGE, offset: (page - 1) * PAGE, sort: order?.id, descending: order?.down }
    : { limit: found > PAGE ? MOST : PAGE };
  // the end of a campaign is worth a question: it is part of this one
  const { value, ...answer } = useAnswer(
    ["sweep points", sweep.id, active, query],
    () => api.sweepPoints(sweep.id, query),
    (now) => (active ? (now?.found ? BUSY_MS : FIRST_MS) : undefined),
  );
  if (value && value.found !== found) setFound(value.found);
  return {
    ...answer,
    value: useLast(value),
    isPage,
    page,
    setPage,
    order,
    setOrder: (next) => {
      setOrder(next);
      setPage(1);
    },
    every: active ? BUSY_MS : undefined,
  };
}

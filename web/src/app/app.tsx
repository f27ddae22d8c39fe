import { Button } from "@mantine/core";
import { useMediaQuery } from "@mantine/hooks";
import { useCallback, useEffect, useState } from "react";
import { ApiError } from "../api/api-error";
import { benchInAddress, showBench } from "../bench/open-bench";
import { pageInAddress, useView } from "../bench/view-store";
import { useBench } from "../stream/bench-store";
import { closeReason } from "../stream/close-reason";
import { EmptyState } from "../ui/empty-state";
import { Announcer } from "./announcer";
import { Banner } from "./banner";
import { openFirstBench } from "./first-bench";
import { Header } from "./header/header";
import { PresentedHeader } from "./header/presented-header";
import { KeySheet } from "./key-sheet";
import { NewBench } from "./new-bench";
import { PAGES } from "./pages";
import { Phone } from "./phone";
import { Rail } from "./rail";
import { ReplayBar } from "./replay-bar";
import { StepBar } from "./step-bar";
import { useKeys } from "./use-keys";
import { useLasting } from "./use-lasting";
import { useReadingSize } from "./use-reading-size";

interface Failure {
  title: string;
  advice: string;
}

/** The page: a header, a line for what needs to be known, and the panels. */
export function App() {
  const phone = useMediaQuery("(max-width: 600px)", undefined, { getInitialValueInEffect: false });
  const page = useView((s) => s.page);
  const silent = useBench((s) => s.connection.staleSince !== undefined);
  const stale = useLasting(silent, 700);
  const Page = PAGES[page].component;
  const [failure, setFailure] = useState<Failure | undefined>(undefined);
  const present = useView((s) => s.present);
  useKeys();
  useReadingSize(phone);

  const start = useCallback(() => {
    setFailure(undefined);
    openFirstBench().catch((error: unknown) => setFailure(explain(error)));
  }, []);

  useEffect(() => {
    start();
    const back = () => {
      useView.setState({ page: pageInAddress() });
      const id = benchInAddress();
      if (id && id !== useBench.getState().bench?.id) showBench(id);
    };
    window.addEventListener("popstate", back);
    return () => window.removeEventListener("popstate", back);
  }, [start]);

  return (
    <div className="page" data-stale={stale} data-present={present}>
      {phone ? null : present ? <PresentedHeader /> : <Header />}
      <ReplayBar />
      <Banner hints={!present && page === "bench"} />
      {page === "bench" && !present && <StepBar />}
      {failure ? (
        <EmptyState title={failure.title} action={<Button onClick={start}>Try again</Button>}>
          {failure.advice}
        </EmptyState>
      ) : (
        <div className="body">
          {!present && <Rail />}
          {phone && page === "bench" ? <Phone /> : <Page />}
        </div>
      )}
      <KeySheet />
      <NewBench />
      <Announcer />
    </div>
  );
}

function explain(error: unknown): Failure {
  if (error instanceof ApiError && error.status === 401) return closeReason(4401);
  if (error instanceof ApiError)
    return {
      title: error.body.message,
      advice: error.body.hint || "Is the server running? Start it with: combbench serve",
    };
  return { title: "The page could not start", advice: String(error) };
}

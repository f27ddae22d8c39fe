import { Button, Group } from "@mantine/core";
import { useMediaQuery } from "@mantine/hooks";
import { useCallback, useEffect, useState } from "react";
import { ApiError } from "../api/client";
import { may, useMe } from "../api/me";
import { resumeLecture, useLecture } from "../bench/lecture";
import { benchInAddress, inAddress, openBench, showBench } from "../bench/open-bench";
import { setPage, showAddress, useView } from "../bench/view-store";
import { View3dHost } from "../panels/view3d/view3d-host";
import { RecordDrop } from "../records/record-drop";
import { RecordSheet } from "../records/record-sheet";
import { useBench } from "../stream/bench-store";
import { closeReason } from "../stream/close-reason";
import { useStaleSince } from "../stream/freshness";
import { EmptyState } from "../ui/empty-state";
import { useTitle } from "../ui/use-title";
import { Announcer } from "./announcer";
import { Banner } from "./banner";
import { ClassLines } from "./class-lines";
import { EditorDrawer } from "./editor-drawer";
import { Ended } from "./ended";
import { comeBack, openFirstBench } from "./first-bench";
import { follow } from "./follow";
import { FullServer } from "./full-server";
import { Header, PageHeader } from "./header/header";
import { KeySheet } from "./key-sheet";
import { LayoutSheet } from "./layout-sheet";
import { LectureStrip } from "./lecture/lecture-strip";
import { MineSheet } from "./mine-sheet";
import { NewBench } from "./new-bench";
import { OpenedLine } from "./opened-line";
import { isOffered, PAGES } from "./pages";
import { Phone } from "./phone";
import { Rail } from "./rail";
import { RecordLine } from "./record-line";
import { ReplayBar } from "./replay-bar";
import { Search } from "./search/search";
import { ShareSheet } from "./share-sheet";
import { Strip } from "./strip";
import strip from "./strip.module.css";
import { useKeys } from "./use-keys";
import { useReadingSize } from "./use-reading-size";
import { VoteCard } from "./vote-card";

interface Failure {
  code: string;
  title: string;
  advice: string;
}

/** The page: a header, a line for alarms, the panels, and the strip under them. */
export function App() {
  const phone = useMediaQuery("(max-width: 600px)", undefined, { getInitialValueInEffect: false });
  const role = useMe((s) => s.me?.role);
  const asked = useView((s) => (s.lost ? "nowhere" : s.page));
  const page = asked === "nowhere" || isOffered(asked, role) ? asked : "bench";
  const onBench = page === "bench";
  const stale = useStaleSince() !== undefined;
  const Page = page === "nowhere" ? Nowhere : PAGES[page].component;
  const [failure, setFailure] = useState<Failure | undefined>(undefined);
  const present = useView((s) => s.present);
  const lectures = useLecture((s) => s.lecture !== undefined);
  useKeys();
  useReadingSize(phone);

  const loggedOut = useBench((s) => s.connection.phase === "closed" && s.connection.reason?.offer === "login");

  const start = useCallback(() => {
    setFailure(undefined);
    openFirstBench().catch((error: unknown) => setFailure(explain(error)));
  }, []);

  const gone = useBench((s) => s.connection.phase === "closed" && s.connection.reason?.offer === "bench");
  useEffect(() => {
    if (gone) comeBack().catch((error: unknown) => setFailure(explain(error)));
  }, [gone]);

  const called = useBench((s) => s.called);
  useEffect(() => {
    if (called && useMe.getState().me?.role === "student")
      follow().catch((error: unknown) => setFailure(explain(error)));
  }, [called]);

  useEffect(() => void resumeLecture(), []);

  useEffect(() => {
    start();
    const back = () => {
      showAddress();
      const id = benchInAddress();
      if (may("branch") && id && id !== useBench.getState().bench?.id) showBench(id);
    };
    window.addEventListener("popstate", back);
    return () => window.removeEventListener("popstate", back);
  }, [start]);

  if (role && role !== "teacher" && (loggedOut || failure?.code === "unauthorised")) return <Ended role={role} />;
  if (!role && !failure) return null; // the contents depend on the role
  return (
    <div className="page" data-stale={stale} data-present={present}>
      {phone || present || failure ? null : onBench ? <Header /> : <PageHeader />}
      {onBench && !present && <ReplayBar />}
      <ClassLines />
      <Banner />
      <VoteCard />
      <OpenedLine />
      {onBench && <RecordLine />}
      {failure?.code === "too_many_benches" ? (
        <FullServer
          onRetry={start}
          onJoin={(id) => {
            setFailure(undefined);
            openBench(id, true);
          }}
        />
      ) : failure ? (
        <EmptyState title={failure.title} action={<Again onRetry={start} />}>
          {failure.advice}
        </EmptyState>
      ) : (
        <div className="body">
          {!present && !(phone && onBench) && <Rail />}
          {phone && onBench ? <Phone /> : <Page />}
          {!phone && <View3dHost />}
        </div>
      )}
      {onBench && <BenchTitle />}
      {!failure && !phone && onBench && <Strip />}
      {!failure && lectures && (phone || !onBench) && (
        <footer className={strip.strip}>
          <div className={strip.row}>
            <LectureStrip />
          </div>
        </footer>
      )}
      <KeySheet />
      <NewBench />
      <RecordSheet />
      <RecordDrop />
      <MineSheet />
      <ShareSheet />
      <LayoutSheet />
      <EditorDrawer />
      <Search />
      <Announcer />
    </div>
  );
}

/** The page at an unknown address. */
function Nowhere() {
  useTitle("Not found");
  return (
    <main>
      <EmptyState
        title="Page not found"
        action={
          <Button variant="filled" size="sm" onClick={() => setPage("bench")}>
            Go to the bench
          </Button>
        }
      >
        The server has no page at {window.location.pathname}.
      </EmptyState>
    </main>
  );
}

function BenchTitle() {
  useTitle(useBench((s) => s.bench?.title));
  return null;
}

/** Try again, or leave the link that led nowhere. */
function Again({ onRetry }: { onRetry(): void }) {
  const ownInstead = () => {
    window.history.replaceState(null, "", "./");
    onRetry();
  };
  return (
    <Group justify="center">
      <Button variant="filled" size="sm" onClick={onRetry}>
        Try again
      </Button>
      {inAddress("link") && (
        <Button size="sm" onClick={ownInstead}>
          Open my own bench
        </Button>
      )}
    </Group>
  );
}

function explain(error: unknown): Failure {
  if (error instanceof ApiError && error.status === 401) return { code: "unauthorised", ...closeReason(4401) };
  if (error instanceof ApiError)
    return {
      code: error.body.code,
      title: error.body.message,
      advice: error.body.hint || "Is the server running? Start it with: combbench serve",
    };
  return { code: "", title: "The page could not start", advice: String(error) };
}

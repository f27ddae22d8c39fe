import { Button, CloseButton } from "@mantine/core";
import { classes } from "../api/classes";
import { useMe } from "../api/me";
import { useClasses } from "../api/use-classes";
import { changeDriver, nameOf, useCompany } from "../bench/driving";
import { openBench } from "../bench/open-bench";
import { showError } from "../bench/send";
import { setPage, useView } from "../bench/view-store";
import { useBench } from "../stream/bench-store";
import { follow, leaveGiven, useGiven } from "./follow";
import { NoticeLine } from "./notice-line";

/** Lines under the header about others: requests to drive, the owner of the bench, the teacher's bench and layout. */
export function ClassLines() {
  const role = useMe((s) => s.me?.role);
  return (
    <>
      <Asked />
      {role === "student" && <Place />}
      {role === "student" && <Given />}
      {role === "teacher" && <Shown />}
    </>
  );
}

/** Another person asks to drive the bench. */
function Asked() {
  const company = useCompany();
  const me = useMe((s) => s.me?.id);
  if (!company || company.driver?.id !== me) return null;
  return company.asking.map((one) => (
    <NoticeLine label="Class" key={one.id} tone="warn" title={`${nameOf(one)} asks to drive this bench.`}>
      <Button variant="filled" onClick={() => changeDriver("hand_over", one)}>
        Hand over
      </Button>
      <Button onClick={() => changeDriver("refuse", one)}>Go on driving</Button>
    </NoticeLine>
  ));
}

/** A student is not at the own bench, or the teacher shows another. */
function Place() {
  const { me, at } = useMe();
  if (!me || !at) return null;
  const goTo = (bench: string) => {
    setPage("bench");
    openBench(bench, true);
  };
  // the own bench may have been replaced meanwhile
  const goHome = () =>
    void follow()
      .then(() => {
        const own = useMe.getState().me?.bench;
        if (own) goTo(own);
      })
      .catch(showError);
  if (at === me.lent && at !== me.bench)
    return (
      <NoticeLine
        label="Class"
        title="Your teacher has handed you this bench."
        text="You drive it until your teacher takes it back."
      >
        <Button variant="filled" onClick={() => changeDriver("leave").then(goHome)}>
          Give it back
        </Button>
      </NoticeLine>
    );
  if (at === me.shown && at !== me.bench)
    return (
      <NoticeLine
        label="Class"
        title="Your teacher shows this bench to all."
        text="You are watching; your own bench keeps running."
      >
        <Button onClick={goHome}>My own bench</Button>
      </NoticeLine>
    );
  if (at === me.shown) return <NoticeLine label="Class" title="Your teacher shows your bench to all." />;
  const other = me.lent ?? me.shown;
  if (!other || at === other) return null;
  return (
    <NoticeLine
      label="Class"
      title={me.lent ? "Your teacher has handed you a bench." : "Your teacher shows a bench to all."}
    >
      <Button variant="filled" onClick={() => goTo(other)}>
        {me.lent ? "Drive it" : "See it"}
      </Button>
    </NoticeLine>
  );
}

/** The teacher has arranged the panels of this page. */
function Given() {
  const given = useGiven((s) => s.given);
  if (!given) return null;
  return (
    <NoticeLine label="Class" title={`Your teacher has arranged your panels: ${given.name}.`}>
      <Button onClick={leaveGiven}>Back to mine</Button>
      <CloseButton size="sm" aria-label="Keep this layout" onClick={() => useGiven.setState({ given: undefined })} />
    </NoticeLine>
  );
}

/** All students of a class see the bench of this page. */
function Shown() {
  const page = useView((s) => s.page);
  const bench = useBench((s) => s.bench?.id);
  const { all, again } = useClasses();
  if (page === "class") return null; // which says so itself
  return all
    .filter(({ shown }) => shown === bench)
    .map(({ id, name }) => (
      <NoticeLine
        label="Class"
        key={id}
        title={`All of ${name} see this bench.`}
        text="They cannot change it; their own benches keep running."
      >
        <Button variant="filled" onClick={() => classes.endShowing(id).then(again, showError)}>
          End showing
        </Button>
      </NoticeLine>
    ));
}

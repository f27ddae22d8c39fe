import { Button, CloseButton } from "@mantine/core";
import type { ReactNode } from "react";
import { classes } from "../api/classes";
import { useMe } from "../api/me";
import { useClasses } from "../api/use-classes";
import { changeDriver, nameOf, useCompany } from "../bench/driving";
import { openBench } from "../bench/open-bench";
import { showError } from "../bench/send";
import { setPage, useView } from "../bench/view-store";
import { useBench } from "../stream/bench-store";
import styles from "./banner.module.css";
import { follow, leaveGiven, useGiven } from "./follow";

/** Lines under the header about others: who asks to drive, whose bench this is, what the teacher shows or has arranged. */
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

/** Somebody asks the person at this page for the bench. */
function Asked() {
  const company = useCompany();
  const me = useMe((s) => s.me?.id);
  if (!company || company.driver?.id !== me) return null;
  return company.asking.map((one) => (
    <Line key={one.id} tone="warn" title={`${nameOf(one)} asks to drive this bench.`}>
      <Button variant="filled" onClick={() => changeDriver("hand_over", one)}>
        Hand over
      </Button>
      <Button onClick={() => changeDriver("refuse", one)}>Go on driving</Button>
    </Line>
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
      <Line title="Your teacher has handed you this bench." text="You drive it until your teacher takes it back.">
        <Button variant="filled" onClick={() => changeDriver("leave").then(goHome)}>
          Give it back
        </Button>
      </Line>
    );
  if (at === me.shown && at !== me.bench)
    return (
      <Line title="Your teacher shows this bench to all." text="You are watching; your own bench keeps running.">
        <Button onClick={goHome}>My own bench</Button>
      </Line>
    );
  if (at === me.shown) return <Line title="Your teacher shows your bench to all." />;
  const other = me.lent ?? me.shown;
  if (!other || at === other) return null;
  return (
    <Line title={me.lent ? "Your teacher has handed you a bench." : "Your teacher shows a bench to all."}>
      <Button variant="filled" onClick={() => goTo(other)}>
        {me.lent ? "Drive it" : "See it"}
      </Button>
    </Line>
  );
}

/** The teacher has arranged the panels of this page. */
function Given() {
  const given = useGiven((s) => s.given);
  if (!given) return null;
  return (
    <Line title={`Your teacher has arranged your panels: ${given.name}.`}>
      <Button onClick={leaveGiven}>Back to mine</Button>
      <CloseButton size="sm" aria-label="Keep this layout" onClick={() => useGiven.setState({ given: undefined })} />
    </Line>
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
      <Line
        key={id}
        title={`All of ${name} see this bench.`}
        text="They cannot change it; their own benches keep running."
      >
        <Button variant="filled" onClick={() => classes.endShowing(id).then(again, showError)}>
          End showing
        </Button>
      </Line>
    ));
}

function Line({
  tone = "note",
  title,
  text,
  children,
}: {
  tone?: "note" | "warn";
  title: string;
  text?: string;
  children?: ReactNode;
}) {
  return (
    <section className={`row ${styles.banner}`} data-tone={tone} aria-label="Class">
      <strong>{title}</strong>
      {text && <span>{text}</span>}
      <div className={`line ${styles.actions}`}>{children}</div>
    </section>
  );
}

import { Button } from "@mantine/core";
import { IconHandStop } from "@tabler/icons-react";
import { may, raiseHand, useMe } from "../../api/me";
import { announce } from "../../bench/announce";
import { showError } from "../../bench/send";
import styles from "./header.module.css";

/** The person at the page: a student by name with a hand to raise, or a watcher; the teacher sees nothing here. */
export function Visitor() {
  const me = useMe((s) => s.me);
  if (!me || may("branch", me.role)) return null;
  if (me.role === "watcher") return <p className={`line ${styles.visitor}`}>You watch this bench</p>;
  const turn = () =>
    raiseHand(!me.hand).then(
      ({ hand }) => announce(hand ? "Your hand is up; the teacher sees it." : "Your hand is down."),
      showError,
    );
  return (
    <div className={`line ${styles.visitor}`}>
      <p title={`${me.name}, ${me.class_name}`}>
        <b className="cut">{me.name}</b>
        <small className="cut">{me.class_name}</small>
      </p>
      <Button
        flex="none"
        variant={me.hand ? "filled" : "default"}
        aria-pressed={me.hand}
        leftSection={<IconHandStop size={16} />}
        title={me.hand ? "Take your hand down" : "The teacher sees it"}
        onClick={turn}
      >
        {me.hand ? "Hand up" : "Raise hand"}
      </Button>
    </div>
  );
}

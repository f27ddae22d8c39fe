import { Button, Group, Menu } from "@mantine/core";
import { IconArrowsMaximize } from "@tabler/icons-react";
import { useCallback, useState } from "react";
import { classes, isLocal, joinAddress } from "../api/classes";
import type { Class } from "../api/types";
import { showError } from "../bench/send";
import { QrCode } from "../ui/qr-code";
import styles from "./class.module.css";
import { brief, Wall } from "./wall";

/** How long a new code lets students in, minutes; longer than any class is until it ends. */
const PERIODS = [
  { label: "for 15 minutes", minutes: 15 },
  { label: "for 1 hour", minutes: 60 },
  { label: "for 2 hours", minutes: 120 },
  { label: "until the class ends", minutes: 60 * 24 * 14 },
];

interface JoiningProps {
  group: Class;
  /** Students have joined: one line is enough, and the wall has the rest. */
  isBrief: boolean;
  onChanged(): void;
}

/** The code in large letters, the address and the end of joining; or that joining is closed. */
export function Joining({ group, isBrief, onChanged }: JoiningProps) {
  const [onWall, setOnWall] = useState(false);
  const leaveWall = useCallback(() => setOnWall(false), []);
  const address = joinAddress(group);
  const change = (done: Promise<Class>) => done.then(onChanged, showError);
  const isAlone = address ? isLocal(address) : false;
  return (
    <section className={`row card ${styles.joining}`} data-brief={isBrief} aria-label="How to join">
      {group.code && address ? (
        <>
          {!isBrief && <QrCode address={address} />}
          <div className={styles.how}>
            <output className={styles.code} aria-label="Join code">
              {group.code}
            </output>
            <p className={styles.address}>{brief(address)}</p>
            <p className={styles.note}>
              {group.code_until && <>Students can join until {clock(group.code_until)}. </>}
              {isAlone && (
                <b>
                  Only this computer can reach this address. Start the server with{" "}
                  <code>combbench serve --classroom</code>.
                </b>
              )}
            </p>
          </div>
        </>
      ) : (
        <p className={styles.note}>Joining is closed. Students who have joined stay.</p>
      )}
      <Group gap={8} className={styles.buttons}>
        {address && (
          <Button
            variant="filled"
            size="sm"
            leftSection={<IconArrowsMaximize size={16} />}
            onClick={() => setOnWall(true)}
          >
            Show on the wall
          </Button>
        )}
        <Menu>
          <Menu.Target>
            <Button size="sm">New code</Button>
          </Menu.Target>
          <Menu.Dropdown>
            <Menu.Label>An earlier code ends at once</Menu.Label>
            {PERIODS.map(({ label, minutes }) => (
              <Menu.Item key={label} onClick={() => change(classes.newCode(group.id, minutes))}>
                {label}
              </Menu.Item>
            ))}
          </Menu.Dropdown>
        </Menu>
        {address && (
          <Button size="sm" onClick={() => change(classes.closeJoining(group.id))}>
            Close joining
          </Button>
        )}
      </Group>
      {group.code && address && (
        <Wall opened={onWall} name={group.name} code={group.code} address={address} onClose={leaveWall} />
      )}
    </section>
  );
}

/** A moment of today by the clock, of another day with its date. */
export function clock(moment: string): string {
  const isToday = new Date(moment).toDateString() === new Date().toDateString();
  const style = isToday ? ({ timeStyle: "short" } as const) : ({ dateStyle: "short", timeStyle: "short" } as const);
  return new Date(moment).toLocaleString([], style);
}

import { Box, Button, Group, NumberInput, Stack, TextInput } from "@mantine/core";
import { type FormEvent, useState } from "react";
import { classes } from "../api/classes";
import type { Class } from "../api/types";
import { PageHead } from "../bench/page-head";
import { useBusy } from "../bench/use-busy";
import { ScenarioSelect } from "./scenario-select";

const LONGEST_H = 24 * 14;
/** The description of a field is below it. */
const BELOW: ("label" | "input" | "description" | "error")[] = ["label", "input", "description", "error"];

interface OpenClassProps {
  onOpened(group: Class): void;
  onCancel?(): void;
}

/** The form that opens a class. */
export function OpenClass({ onOpened, onCancel }: OpenClassProps) {
  const [name, setName] = useState("");
  const [scenario, setScenario] = useState("first-look");
  const [hours, setHours] = useState<number | string>(8);
  const [minutes, setMinutes] = useState<number | string>(120);
  const [busy, during] = useBusy();
  const wrong = {
    hours: Number(hours) > 0 && Number(hours) <= LONGEST_H ? undefined : `More than 0, at most ${LONGEST_H}`,
    minutes: Number(minutes) > 0 && Number(minutes) <= 60 * LONGEST_H ? undefined : "More than 0",
  };
  const open = (event: FormEvent) => {
    event.preventDefault();
    const bench = { scenario, paused: false, quiet_lead: true };
    const wanted = { name: name.trim(), bench, hours: Number(hours), minutes: Number(minutes) };
    void during(() => classes.open(wanted).then(onOpened));
  };
  return (
    <Box
      component="section"
      className="card"
      w="min(460px, 100%)"
      m="4vh auto auto"
      p="20px 24px 24px"
      aria-label="Open a class"
    >
      <PageHead name="Class" />
      <Box component="p" m="8px 0 16px" c="dimmed">
        Students join a class with a code from the wall, without an account. Each has a bench of their own, and you see
        all of them here.
      </Box>
      <Stack component="form" gap={14} onSubmit={open}>
        <TextInput
          size="sm"
          label="Name of the class"
          placeholder="Control laboratory, Tuesday"
          required
          maxLength={100}
          value={name}
          onChange={(e) => setName(e.currentTarget.value)}
        />
        <ScenarioSelect size="sm" label="Benches begin with" value={scenario} onChange={setScenario} />
        <NumberInput
          size="sm"
          label="Duration"
          description="Everything is deleted when it ends."
          inputWrapperOrder={BELOW}
          suffix=" h"
          min={0.1}
          value={hours}
          error={wrong.hours}
          onChange={setHours}
        />
        <NumberInput
          size="sm"
          label="The code lets students in for"
          description="You can make a new one at any time."
          inputWrapperOrder={BELOW}
          suffix=" min"
          min={1}
          value={minutes}
          error={wrong.minutes}
          onChange={setMinutes}
        />
        <Group gap={8}>
          <Button
            variant="filled"
            size="sm"
            type="submit"
            loading={busy}
            disabled={!name.trim() || Boolean(wrong.hours || wrong.minutes)}
          >
            Open the class
          </Button>
          {onCancel && (
            <Button size="sm" onClick={onCancel}>
              Back
            </Button>
          )}
        </Group>
      </Stack>
    </Box>
  );
}

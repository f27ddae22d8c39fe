import { Box, Button, NativeSelect, SimpleGrid, Switch, Text, TextInput } from "@mantine/core";
import { IconClipboardList, IconFolderOpen, IconRulerMeasure, IconWaveSine } from "@tabler/icons-react";
import { useEffect, useState } from "react";
import { api } from "../api/api";
import { useMay } from "../api/me";
import type { Device, MeasuredDevice, ScenarioSummary } from "../api/types";
import { openOwn } from "../bench/open-bench";
import { showError } from "../bench/send";
import { useBusy } from "../bench/use-busy";
import { setPage, useView } from "../bench/view-store";
import { byChapter } from "../gallery/chapters";
import { showSheet } from "../panels/sheet/begin";
import { useRecords } from "../records/open-record";
import { EmptyState } from "../ui/empty-state";
import styles from "./dialogs.module.css";
import { InstrumentOffer } from "./instrument-offer";
import { SideSheet } from "./side-sheet";

/** Start a bench from the library, on its own device or another; a study has no bench. */
export function NewBench() {
  return (
    <SideSheet name="bench" title="New bench" size={520}>
      <Gallery />
    </SideSheet>
  );
}

/** Whether a device suits the plant of a scenario. */
const suits = (device: Device, scenario: ScenarioSummary) => device.plants.includes(scenario.plant ?? "");

/** By the first word of a verdict. */
const COLOURS: Record<string, string> = {
  reproduced: "var(--running)",
  ours: "var(--accent)",
  partly: "var(--paused)",
  not: "var(--paused)",
};

const closeAnd = (open: () => void) => () => {
  useView.setState({ dialog: "none" });
  open();
};

const beginSheet = () => {
  setPage("bench");
  showSheet();
};

function Gallery() {
  const [scenarios, setScenarios] = useState<ScenarioSummary[] | undefined>(undefined);
  const [devices, setDevices] = useState<Device[]>([]);
  const [measured, setMeasured] = useState<MeasuredDevice[]>([]);
  const [device, setDevice] = useState("");
  const [query, setQuery] = useState("");
  const [paused, setPaused] = useState(false);
  const [busy, during] = useBusy<string>();
  const teaches = useMay("teach");

  useEffect(() => {
    api.scenarios().then(setScenarios, showError);
    api.devices().then(setDevices, showError);
    api.measuredDevices().then(setMeasured, showError);
  }, []);

  const own = measured.find(({ id }) => id === device);
  const start = (scenario: string) =>
    during(async () => {
      const bench = await api.createBench({
        scenario,
        paused,
        quiet_lead: true,
        ...(device && !own ? { set: { "device.id": device } } : {}),
        ...(own ? { device: own.id } : {}),
      });
      openOwn(bench.id);
      useView.setState({ dialog: "none" });
    }, scenario);

  const benches = scenarios?.filter((s) => s.plant !== null).sort(byChapter);
  const chosen = devices.find((d) => d.id === device);
  const found = benches?.filter(
    (s) =>
      `${s.id} ${s.title} ${s.summary}`.toLowerCase().includes(query.toLowerCase()) &&
      (!chosen || suits(chosen, s)) &&
      (!own || s.plant === "linear"),
  );
  const unsuited = chosen && benches ? benches.filter((s) => !suits(chosen, s)).length : 0;
  const fromDisk = "Open a scenario from disk";
  const others = [
    { Icon: IconRulerMeasure, words: "Design a device of your own", open: closeAnd(() => setPage("designer")) },
    {
      Icon: IconFolderOpen,
      words: teaches ? `${fromDisk}, or one of mine` : fromDisk,
      open: () => useView.setState({ dialog: "mine" }),
    },
    {
      Icon: IconWaveSine,
      words: "Open a record of your device",
      open: () => {
        useRecords.setState({ shown: undefined, file: undefined });
        useView.setState({ dialog: "record" });
      },
    },
    { Icon: IconClipboardList, words: "Begin a lab sheet", open: closeAnd(beginSheet) },
  ];
  return (
    <>
      {!teaches && <p className={styles.remark}>It takes the place of your bench.</p>}
      {others.map(({ Icon, words, open }) => (
        <Button key={words} fullWidth size="xs" mb="sm" leftSection={<Icon size={16} />} onClick={open}>
          {words}
        </Button>
      ))}
      {teaches && benches && <InstrumentOffer scenarios={benches.filter((s) => s.can_hide)} devices={measured} />}
      <SimpleGrid cols={2} spacing={12} mb={8} style={{ alignItems: "end" }}>
        <TextInput label="Search" value={query} onChange={(e) => setQuery(e.currentTarget.value)} data-autofocus />
        <NativeSelect
          label="Device"
          value={device}
          data={[
            { value: "", label: "the scenario's own" },
            ...devices.map((d) => ({ value: d.id, label: d.title })),
            ...measured.map((d) => ({ value: d.id, label: `${d.name}, measured` })),
          ]}
          onChange={(e) => setDevice(e.currentTarget.value)}
        />
        <Switch label="Start paused" checked={paused} onChange={(e) => setPaused(e.currentTarget.checked)} />
      </SimpleGrid>
      {!found && <Text c="dimmed">Loading the library…</Text>}
      {unsuited > 0 && (
        <Text c="dimmed" size="xs" mb={4}>
          {unsuited} scenarios are for another kind of device.
        </Text>
      )}
      {found?.length === 0 && <EmptyState title="Nothing matches">Try another word.</EmptyState>}
      <ul className={styles.gallery}>
        {found?.map((s) => (
          <li key={s.id}>
            <div>
              <h3>{s.title}</h3>
              <p className="note">{s.summary || s.claim}</p>
              <small>
                {s.id}
                {s.source && ` · ${s.source}`}
                {s.verdict && (
                  <Box component="span" c={COLOURS[s.verdict.split(" ")[0]]}>
                    {" "}
                    · {s.verdict}
                  </Box>
                )}
              </small>
            </div>
            <Button
              flex="none"
              size="xs"
              variant="light"
              loading={busy === s.id}
              onClick={() => start(s.id)}
              aria-label={`Start ${s.title}`}
            >
              Start
            </Button>
          </li>
        ))}
      </ul>
    </>
  );
}

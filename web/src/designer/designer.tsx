import { Box, Button, Group } from "@mantine/core";
import { IconDice5, IconPlayerPlay } from "@tabler/icons-react";
import { useEffect, useState } from "react";
import { api } from "../api/api";
import { useMay } from "../api/me";
import type { DeviceCatalogue, Evaluation, ProcessSpread } from "../api/types";
import { openOwn } from "../bench/open-bench";
import { PageHead } from "../bench/page-head";
import { showError, showing } from "../bench/send";
import { useBusy } from "../bench/use-busy";
import { openPlace, setPage, useView } from "../bench/view-store";
import { EmptyState } from "../ui/empty-state";
import { formatSi } from "../ui/format";
import { AxesView } from "./axes-view";
import {
  benchOf,
  catalogued,
  type DesignState,
  designDocument,
  gyroscopeBenchOf,
  isGyroscope,
  newDesign,
} from "./design";
import styles from "./designer.module.css";
import { DesignerControls } from "./designer-controls";
import { DeviceView } from "./device-view";
import { FigureGrid } from "./figure-grid";
import { ResponseView } from "./response-view";
import { SensitivityTable } from "./sensitivity-table";
import { useDesign } from "./use-design";

const FIRST = "lcr-350";

/** The others are worked out from the drawing of a resonator. */
const isOfGyroscope = ({ name }: { name: string }) => name.startsWith("gyro.");

/** The drawing board: turn a number of a device and see its effect at once. */
export function Designer() {
  const drives = useMay("drive");
  const teaches = useMay("teach");
  const [catalogue, setCatalogue] = useState<DeviceCatalogue | undefined>(undefined);
  const item = useView((s) => s.item);
  const [state, setState] = useState(() => newDesign(FIRST));
  const [original, setOriginal] = useState<Evaluation | undefined>(undefined);
  const [spread, setSpread] = useState<ProcessSpread["statistics"][string] | undefined>(undefined);
  const [busy, during] = useBusy();
  const { evaluation, bode, drawing, refusal, design } = useDesign(state);
  const isTurning = evaluation !== undefined && "gyro.axis_deg" in evaluation.metrics;

  useEffect(() => {
    api.deviceCatalogue().then(setCatalogue, showError);
  }, []);
  const isKnown = catalogue?.devices.some(({ id }) => id === item);
  useEffect(() => {
    if (isKnown) setState((now) => (now.id === item ? now : newDesign(item)));
  }, [isKnown, item]);
  useEffect(() => {
    api.evaluate({ device: { id: state.id }, environment: {} }).then(setOriginal, showError);
  }, [state.id]);

  const device = catalogue?.devices.find((d) => d.id === state.id);
  const change = (next: DesignState) => {
    setState(next);
    if (next.id !== state.id) openPlace("designer", next.id, true);
  };
  const draw = showing(async () => {
    const seed = (state.drawn?.seed ?? 0) + 1;
    const undrawn = { ...state, drawn: undefined };
    const { geometry, statistics } = await api.spread({ ...designDocument(undrawn), seed });
    setState({ ...undrawn, drawn: { seed, geometry } });
    setSpread(statistics.f0_hz);
  });
  const use = () =>
    during(async () => {
      if (!evaluation) return;
      const wanted = isGyroscope(device) ? gyroscopeBenchOf : benchOf;
      openOwn((await api.createBench(wanted(design, evaluation.title, evaluation.metrics))).id);
      setPage("bench");
    });

  if (!catalogue || !device)
    return <EmptyState title="Loading the devices">They come from the server's catalogue.</EmptyState>;
  return (
    <main className={`paper ${styles.page}`}>
      <header className={`card page-top ${styles.top}`}>
        <PageHead name="Design" item={isKnown ? device.title : undefined} heading="Device designer" />
        {item && !isKnown && <span className="wrong">The catalogue has no device {item}.</span>}
        {state.drawn && (
          <Box component="span" c="var(--accent)" bg="var(--accent-soft)" bdrs={10} fz="sm" p="2px 10px">
            device {state.drawn.seed} of the process
            {spread &&
              `; 98 % of them have f₀ from ${formatSi(spread.p01, "Hz", 3)} to ${formatSi(spread.p99, "Hz", 3)}`}
          </Box>
        )}
        {refusal && (
          <span className="wrong" role="alert">
            {refusal.body.message}. {refusal.body.hint}
          </span>
        )}
        <Group gap={8} ml="auto">
          {state.drawn && (
            <Button size="xs" onClick={() => setState({ ...state, drawn: undefined })}>
              Back to the drawing
            </Button>
          )}
          <Button
            size="xs"
            leftSection={<IconDice5 size={16} />}
            disabled={isGyroscope(device) || catalogued(device, "geometry.beam_length_um") === undefined}
            title="A device as the process might make it; the same number gives the same device"
            onClick={draw}
          >
            {state.drawn ? "Draw another" : "Draw one from the process"}
          </Button>
          {drives && (
            <Button
              variant="filled"
              size="xs"
              leftSection={<IconPlayerPlay size={16} />}
              title={teaches ? undefined : "It takes the place of your bench"}
              loading={busy}
              disabled={!evaluation || refusal !== undefined}
              onClick={use}
            >
              Use on the bench
            </Button>
          )}
        </Group>
      </header>
      <DesignerControls catalogue={catalogue} device={device} state={state} onChange={change} />
      {evaluation && (isTurning || (bode && drawing)) ? (
        <>
          <section className={`column card ${styles.drawing}`} aria-label="Drawing">
            {isTurning ? (
              <AxesView metrics={evaluation.metrics} title={evaluation.title} />
            ) : (
              <DeviceView
                geometry={evaluation.geometry}
                title={evaluation.title}
                onChooseDrawn={() => setState(newDesign(FIRST))}
              />
            )}
          </section>
          <div className={`column ${styles.results}`}>
            <section className={`card ${styles.figures}`} aria-label="Figures">
              <FigureGrid
                figures={isTurning ? evaluation.figures.filter(isOfGyroscope) : evaluation.figures}
                original={original?.figures}
                drawn={isTurning || evaluation.geometry !== null}
              />
            </section>
            {bode && drawing && (
              <>
                <section className={`card ${styles.response}`} aria-label="Frequency response">
                  <ResponseView bode={bode} drawing={drawing} />
                </section>
                <section className={`card ${styles.sensitivity}`} aria-label="Sensitivity">
                  <SensitivityTable evaluation={evaluation} />
                </section>
              </>
            )}
          </div>
        </>
      ) : (
        <EmptyState title="Working it out">Figures, drawing and response appear with the first answer.</EmptyState>
      )}
    </main>
  );
}

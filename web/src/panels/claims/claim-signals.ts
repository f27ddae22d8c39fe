const USUAL = ["plant.displacement", "model.displacement"];
const PARTNERS: Partial<Record<string, string>> = {
  "drive.voltage": "reference.voltage",
  "plant.displacement": "model.displacement",
};

/** Signals to show together with some signals on a scope. */
export const partnersOf = (signals: readonly string[]): string[] =>
  signals.flatMap((name) => PARTNERS[name] ?? []).filter((name) => !signals.includes(name));

/** A weighted parameter, or the weighted displacement or rate beside the true one. */
function weightedBeside(name: string, metric: string): string[] {
  const part = /rms_error_(mass|stiffness|damping|second_stiffness)_pct$/.exec(metric)?.[1];
  const port = /rms_error_(x|y|rate)_(?:um|dps)$/.exec(metric)?.[1];
  if (port) return [`${name}.weighted.${port}`, port === "rate" ? "rate.rate" : `plant.${port}`];
  return part ? [`${name}.weighted.${part}`] : [`${name}.weighted.displacement`, "plant.displacement"];
}

/** The signals a claim without marks is about, as far as the name of its metric tells. */
export function signalsOf(metric: string, known: readonly string[]): string[] {
  const [family, name] = metric.replace(/^twins\.[^.]+\./, "").split(".");
  const wanted =
    family === "diagnosis"
      ? known.filter((signal) => signal.startsWith(`${name}.probability.`))
      : family === "estimation"
        ? weightedBeside(name, metric)
        : family === "identify"
          ? [`${name}.error_pct`]
          : metric.includes("effort")
            ? ["drive.voltage", "reference.voltage"]
            : metric.includes("error")
              ? ["model.tracking_error"]
              : USUAL;
  const found = wanted.filter((signal) => known.includes(signal));
  return found.length > 0 ? found : known.slice(0, 2);
}

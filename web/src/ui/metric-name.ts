import { unitText } from "./unit-scale";

/** A metric in words: "diagnosis.kalman.correct_fraction" reads "kalman correct fraction". */
export function metricName(metric: string): string {
  return metric
    .replace(/^(?:control|device|diagnosis|identify|lateral|sensing)\./, "")
    .replace(/^twins\.([^.]+)\./, "$1: ")
    .replaceAll(/[._]/g, " ")
    .replaceAll(/\bum\b/g, "µm")
    .replaceAll(/\bpct\b/g, "%");
}

/** Units by the ending that the names of fields have for them. */
const UNITS: Record<string, string> = {
  um: "um",
  nm: "nm",
  pm: "pm",
  pct: "%",
  ms: "ms",
  us: "us",
  s: "s",
  hz: "Hz",
  khz: "kHz",
  v: "V",
  pa: "Pa",
  kg: "kg",
  nn: "nN",
  un: "uN",
  db: "dB",
  deg: "deg",
  mrad: "mrad",
  samples: "samples",
  n_m: "N/m",
  n_m3: "N/m^3",
  ns_m: "N s/m",
  n_per_v: "N/V",
  v_um: "V/um",
  v_um_ms: "V/(um ms)",
  v_ms_um: "V ms/um",
  um_ms: "um/ms",
  deg_h: "deg/h",
  deg_rt_h: "deg/rt h",
};

/** A metric as the title of an axis: "noise_um" reads "noise, µm". */
export function metricTitle(metric: string): string {
  const parts = metric.split("_");
  for (let i = 1; i < parts.length; i += 1) {
    const unit = UNITS[parts.slice(i).join("_")]; // the longest ending first: V/µm before µm
    if (unit) return `${metricName(parts.slice(0, i).join("_"))}, ${unitText(unit)}`;
  }
  return metricName(metric);
}

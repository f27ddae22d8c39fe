/** Scopes worth opening, by the signals they show. */
const PRESETS: { title: string; pick: RegExp }[] = [
  { title: "Displacement", pick: /^(model|plant|sensor)\.displacement$/ },
  { title: "Tracking error", pick: /^model\.tracking_error$/ },
  { title: "Rate and its estimates", pick: /^[a-z_]+\.rate$/ },
  { title: "Motion along x and y", pick: /^plant\.(partner_)?[xy]$/ },
  { title: "Forces", pick: /^drive\.(partner_)?[xy]\.force$/ },
  { title: "Quadrature", pick: /^[a-z_]+\.quadrature$/ },
  { title: "Identified stiffness and damping", pick: /^(adaptive_rate|mimo_adaptive)\.[kd](xx|xy|yy)$/ },
  { title: "Voltage", pick: /^(reference|drive)\.voltage$/ },
  { title: "Voltage of each controller", pick: /^(?!reference|drive).+\.voltage$/ },
  { title: "Adaptive gains", pick: /^mrac[^.]*\.gain(_ideal)?\./ },
  { title: "Adaptation error", pick: /^mrac[^.]*\.(error|augmented_error|auxiliary_error)$/ },
  { title: "Residuals", pick: /\.residual\./ },
  { title: "Residuals along x", pick: /\.residual_x\./ },
  { title: "Residuals along y", pick: /\.residual_y\./ },
  { title: "Fault severity", pick: /^faults\./ },
];

/** Scopes of a bench with twins: the same signal of all of them. */
const OF_TWINS: typeof PRESETS = [
  { title: "Displacement with twins", pick: /^([a-z0-9_]+:)?plant\.displacement$/ },
  { title: "Rate with twins", pick: /^([a-z0-9_]+:)?[a-z_]+\.rate$/ },
  { title: "Voltage with twins", pick: /^([a-z0-9_]+:)?drive\.voltage$/ },
];

/** The presets with signals on a bench. */
export function presetsOn(signals: readonly { name: string }[]) {
  const names = signals.map(({ name }) => name);
  const presets = names.some((name) => name.includes(":")) ? [...PRESETS, ...OF_TWINS] : PRESETS;
  return presets
    .map(({ title, pick }) => ({ title, signals: names.filter((name) => pick.test(name)) }))
    .filter((preset) => preset.signals.length > 0);
}

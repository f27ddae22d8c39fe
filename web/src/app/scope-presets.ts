/** Scopes worth opening, by the signals they show; what a bench does not have is left out. */
export const SCOPE_PRESETS: { title: string; pick: RegExp }[] = [
  { title: "Displacement", pick: /^(model|plant|sensor)\.displacement$/ },
  { title: "Voltage", pick: /^(reference|drive)\.voltage$/ },
  { title: "What each controller would do", pick: /^(?!reference|drive).+\.voltage$/ },
  { title: "Adaptation", pick: /^mrac[^.]*\.gain(_ideal)?\./ },
  { title: "Adaptation error", pick: /^mrac[^.]*\.(error|augmented_error|auxiliary_error)$/ },
  { title: "Residuals", pick: /\.residual\./ },
  { title: "Fault severity", pick: /^faults\./ },
];

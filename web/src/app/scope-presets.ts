/** Scopes worth opening, by the signals they show; what a bench does not have is left out. */
export const SCOPE_PRESETS: { title: string; pick: RegExp }[] = [
  { title: "Displacement", pick: /^(model|plant|sensor)\.displacement$/ },
  { title: "Tracking error", pick: /^model\.tracking_error$/ },
  { title: "Rate, and every estimate of it", pick: /^[a-z_]+\.rate$/ },
  { title: "Motion", pick: /^plant\.(partner_)?[xy]$/ },
  { title: "Forces", pick: /^drive\.(partner_)?[xy]\.force$/ },
  { title: "Quadrature", pick: /^[a-z_]+\.quadrature$/ },
  { title: "What adaptive control learns", pick: /^(adaptive_rate|mimo_adaptive)\.[kd](xx|xy|yy)$/ },
  { title: "Voltage", pick: /^(reference|drive)\.voltage$/ },
  { title: "What each controller would do", pick: /^(?!reference|drive).+\.voltage$/ },
  { title: "Adaptation", pick: /^mrac[^.]*\.gain(_ideal)?\./ },
  { title: "Adaptation error", pick: /^mrac[^.]*\.(error|augmented_error|auxiliary_error)$/ },
  { title: "Residuals", pick: /\.residual\./ },
  { title: "Residuals along x", pick: /\.residual_x\./ },
  { title: "Residuals along y", pick: /\.residual_y\./ },
  { title: "Fault severity", pick: /^faults\./ },
];

const LOWEST = 1e-9;

/** Place of a relative excitation on a logarithmic meter from 1e-9 to 1. */
export function meterShare(relative: number): number {
  if (!(relative > LOWEST)) return 0;
  return Math.min(1, 1 - Math.log10(relative) / Math.log10(LOWEST));
}

/** A stretch of columns over which an index signal keeps one value. */
export interface Run {
  value: number;
  from: number;
  /** One past the last column. */
  to: number;
}

/** Stretches of equal value; columns without data belong to the stretch before them. */
export function runs(values: Float32Array): Run[] {
  const found: Run[] = [];
  for (let c = 0; c < values.length; c += 1) {
    const value = values[c];
    const last = found.at(-1);
    if (Number.isNaN(value)) {
      if (last) last.to = c + 1;
    } else if (last && last.value === value) last.to = c + 1;
    else found.push({ value, from: c, to: c + 1 });
  }
  return found;
}

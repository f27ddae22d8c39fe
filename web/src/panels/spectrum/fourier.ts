/** Amplitudes of the tones in a record. */
export interface Spectrum {
  /** kHz, when the record is in ms. */
  frequency: Float64Array;
  amplitude: Float64Array;
}

/** The largest power of two that is not above a number. */
export const powerOfTwo = (count: number): number => 2 ** Math.floor(Math.log2(Math.max(1, count)));

/**
 * One-sided amplitude spectrum of the newest 2^n samples under a Hann window: a sine of amplitude A on a bin reads A.
 */
export function spectrum(samples: Float32Array, dt: number): Spectrum {
  const n = powerOfTwo(samples.length);
  const re = new Float64Array(n);
  const im = new Float64Array(n);
  const first = samples.length - n;
  let mean = 0;
  for (let i = 0; i < n; i += 1) mean += samples[first + i] / n;
  for (let i = 0; i < n; i += 1) re[i] = (samples[first + i] - mean) * (0.5 - 0.5 * Math.cos((2 * Math.PI * i) / n));
  transform(re, im);
  const half = n / 2;
  const frequency = new Float64Array(half);
  const amplitude = new Float64Array(half);
  for (let i = 0; i < half; i += 1) {
    frequency[i] = i / (n * dt);
    // two sides, over the mean of the window, which is one half
    amplitude[i] = (4 * Math.hypot(re[i], im[i])) / n;
  }
  return { frequency, amplitude };
}

/** Fast Fourier transform in place, radix 2. */
function transform(re: Float64Array, im: Float64Array): void {
  const n = re.length;
  for (let i = 1, j = 0; i < n; i += 1) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) {
      [re[i], re[j]] = [re[j], re[i]];
      [im[i], im[j]] = [im[j], im[i]];
    }
  }
  for (let size = 2; size <= n; size *= 2) {
    const turn = (-2 * Math.PI) / size;
    for (let k = 0; k < size / 2; k += 1) {
      const c = Math.cos(turn * k);
      const s = Math.sin(turn * k);
      for (let i = k; i < n; i += size) {
        const j = i + size / 2;
        const x = re[j] * c - im[j] * s;
        const y = re[j] * s + im[j] * c;
        re[j] = re[i] - x;
        im[j] = im[i] - y;
        re[i] += x;
        im[i] += y;
      }
    }
  }
}

/**
 * The strongest tone. Between bins a Hann window reads `A sinc(d) / (1 - d^2)` at a distance of d bins, so the ratio of
 * the two bins beside the tone gives d, and d the amplitude.
 */
export function strongest({ frequency, amplitude }: Spectrum): { frequency: number; amplitude: number } | undefined {
  let top = 2;
  for (let i = 3; i < amplitude.length - 1; i += 1) if (amplitude[i] > amplitude[top]) top = i;
  if (amplitude.length < 8 || !(amplitude[top] > 0)) return undefined;
  const side = amplitude[top + 1] >= amplitude[top - 1] ? 1 : -1;
  const ratio = amplitude[top + side] / amplitude[top];
  const d = Math.max(0, (2 * ratio - 1) / (ratio + 1));
  const sinc = d === 0 ? 1 : Math.sin(Math.PI * d) / (Math.PI * d);
  return {
    frequency: (top + side * d) * (frequency[1] - frequency[0]),
    amplitude: (amplitude[top] * (1 - d * d)) / sinc,
  };
}

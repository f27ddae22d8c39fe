/** A text of the server with its units as they are printed: "20 us, 3 um/V" reads "20 µs, 3 µm/V". */
export const micro = (text: string): string =>
  text.replace(/(\d)\s?u([msNVg])\b/g, "$1\u00a0µ$2").replace(/(^|[\s(,;/*])u([mNV])\b(?!\s*=)/g, "$1µ$2");

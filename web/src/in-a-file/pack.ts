/** Arrays of a pack by the kind of their numbers. */
const KINDS = {
  float64: Float64Array,
  float32: Float32Array,
  int64: BigInt64Array,
  uint64: BigUint64Array,
} as const;
const ALIGNMENT = 8;

/** Bytes from a text that the file has: compressed, in base 64. */
export const bytesOf = (text: string): Promise<Uint8Array<ArrayBuffer>> =>
  inflated(Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0)));

/** Bytes that were compressed. */
export async function inflated(compressed: Uint8Array<ArrayBuffer>): Promise<Uint8Array<ArrayBuffer>> {
  const stream = new Blob([compressed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The document of a pack, with its arrays in place. */
export function unpacked<T>(bytes: Uint8Array<ArrayBuffer>): T {
  const length = Number(new DataView(bytes.buffer, bytes.byteOffset).getBigUint64(0, true));
  const head = new TextDecoder().decode(bytes.subarray(ALIGNMENT, ALIGNMENT + length));
  const first = Math.ceil((ALIGNMENT + length) / ALIGNMENT) * ALIGNMENT;
  return JSON.parse(head, (_, value) => {
    if (typeof value?.array !== "string") return value;
    const kind = KINDS[value.array as keyof typeof KINDS];
    const count = value.lengths.reduce((product: number, one: number) => product * one, 1);
    const start = bytes.byteOffset + first + value.at;
    return new kind(bytes.buffer.slice(start, start + count * kind.BYTES_PER_ELEMENT));
  });
}

import { expect, it } from "vitest";
import { bytesOf, unpacked } from "./pack";

/** As Python writes it: the length of the document, the document, and the arrays from multiples of eight on. */
function packOf(document: unknown, ...arrays: ArrayBuffer[]): Uint8Array<ArrayBuffer> {
  const head = new TextEncoder().encode(JSON.stringify(document));
  const first = Math.ceil((8 + head.length) / 8) * 8;
  const bytes = new Uint8Array(first + arrays.reduce((sum, one) => sum + one.byteLength, 0));
  new DataView(bytes.buffer).setBigUint64(0, BigInt(head.length), true);
  bytes.set(head, 8);
  let at = first;
  for (const one of arrays) {
    bytes.set(new Uint8Array(one), at);
    at += one.byteLength;
  }
  return bytes;
}

it("puts each array in its place, by its kind and its lengths", () => {
  const numbers = Float64Array.from([0.1, Number.NaN, -0, Number.POSITIVE_INFINITY]);
  const places = BigInt64Array.from([-1n, 2n ** 62n]);
  const document = {
    a: [{ array: "float64", at: 0, lengths: [2, 2] }],
    b: { array: "int64", at: 32, lengths: [2] },
    c: "text",
  };
  const found = unpacked<{ a: Float64Array[]; b: BigInt64Array; c: string }>(
    packOf(document, numbers.buffer, places.buffer),
  );
  expect(found).toEqual({ a: [numbers], b: places, c: "text" });
});

it("reads bytes from a text of the file", async () => {
  const stream = new Blob(["combs"]).stream().pipeThrough(new CompressionStream("gzip"));
  const compressed = new Uint8Array(await new Response(stream).arrayBuffer());
  const bytes = await bytesOf(`${btoa(String.fromCharCode(...compressed))}\n`);
  expect(new TextDecoder().decode(bytes)).toBe("combs");
});

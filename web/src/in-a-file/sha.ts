/** The SHA-256 of texts and bytes, one after another. */
export async function digestOf(parts: BlobPart[]): Promise<string> {
  const hash = await crypto.subtle.digest("SHA-256", await new Blob(parts).arrayBuffer());
  return [...new Uint8Array(hash)].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}

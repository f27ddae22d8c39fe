import { api } from "./api";
import { ApiError } from "./api-error";

/** Why a stream would not open: the close code that fits, or undefined when the server does not answer. */
export async function benchExists(id: string): Promise<number | undefined> {
  try {
    await api.bench(id);
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    if (error.status === 401) return 4401;
    if (error.status === 403) return 4003;
    if (error.status === 404) return 4404;
  }
  return undefined;
}

import { leaveLecture } from "../../bench/lecture";
import { setLayout } from "../layouts";

/** Leave the lecture: the bench and the layout are as before it. */
export async function leave(): Promise<void> {
  const before = await leaveLecture();
  if (before) setLayout(before.layout);
}

import { useMediaQuery } from "@mantine/hooks";
import { Notifications } from "@mantine/notifications";

/** Notes that come and go, where they cover nothing one needs at once: on a phone the stop button is at the bottom. */
export function Toasts() {
  const phone = useMediaQuery("(max-width: 600px)", undefined, { getInitialValueInEffect: false });
  return <Notifications position={phone ? "top-center" : "bottom-right"} limit={phone ? 1 : 4} />;
}

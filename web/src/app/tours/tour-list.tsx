import { Button, Group } from "@mantine/core";
import { useViewportSize } from "@mantine/hooks";
import { useMay } from "../../api/me";
import dialogs from "../dialogs.module.css";
import { startTour, TOUR_PX } from "./run-tour";
import { TOURS } from "./tours";

/** The tours: each drives the page on a bench of its own and puts all back. */
export function TourList() {
  const teaches = useMay("teach");
  const { width } = useViewportSize();
  if (!teaches) return null;
  const narrow = (width || window.innerWidth) < TOUR_PX;
  return (
    <>
      <h3 className={dialogs.heading}>Tours</h3>
      <p>
        {narrow
          ? "Tours need a wider screen than this one."
          : "Each drives this page on a bench of its own for a minute. Escape leaves; all is then as before."}
      </p>
      <Group gap={6}>
        {TOURS.map((tour) => (
          <Button key={tour.title} disabled={narrow} onClick={() => void startTour(tour)}>
            {tour.title}
          </Button>
        ))}
      </Group>
    </>
  );
}

/** The first tour, offered once with the hints to a new user. */
export function OfferTour() {
  const { width } = useViewportSize();
  if ((width || window.innerWidth) < TOUR_PX) return null;
  return <Button onClick={() => void startTour(TOURS[0])}>Take the tour</Button>;
}

import { create } from "zustand";

interface Places {
  /** Whether the page keeps the 3D view itself and lays it over a panel; a phone draws it where it stands. */
  hosted: boolean;
  /** Panels that offer their place, the latest last. */
  places: HTMLElement[];
}

/** Where the 3D view may be shown. */
export const usePlaces = create<Places>(() => ({ hosted: false, places: [] }));

/** Offer the place of a panel; returns what takes the offer back. */
export function offerPlace(place: HTMLElement): () => void {
  usePlaces.setState(({ places }) => ({ places: [...places, place] }));
  return () => usePlaces.setState(({ places }) => ({ places: places.filter((other) => other !== place) }));
}

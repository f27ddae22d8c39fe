/** Where to look at the device from; the 3D page knows each by its name. */
export const CAMERAS = [
  { name: "whole", label: "Whole", title: "The whole device" },
  { name: "top", label: "Top", title: "From above, as drawn" },
  { name: "side", label: "Side", title: "Along the wafer" },
  { name: "fingers", label: "Fingers", title: "The fingers of a comb" },
  { name: "beams", label: "Beams", title: "The folded beams of one side" },
] as const;

export type Camera = (typeof CAMERAS)[number]["name"];

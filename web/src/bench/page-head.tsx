import { ActionIcon, Anchor, Box, Tooltip } from "@mantine/core";
import { IconCheck, IconLink } from "@tabler/icons-react";
import { type MouseEvent, type ReactNode, useState } from "react";
import { copyText } from "../ui/copy-text";
import { useTitle } from "../ui/use-title";
import { announce } from "./announce";
import { addressOf, type Place } from "./places";
import { openPlace, useView } from "./view-store";

interface PageHeadProps {
  name: string;
  /** The one thing that is shown of many. */
  item?: string;
  /** The heading, where it is not the name. */
  heading?: string;
}

/** The heading of a page: it names the window, and its link is copied here. */
export function PageHead({ name, item, heading = name }: PageHeadProps) {
  useTitle(item, name);
  const address = useView(({ page, item: one }) => addressOf({ page, item: one }));
  const [copied, setCopied] = useState("");
  const copy = async () => {
    await copyText(address);
    setCopied(address);
    announce("Link copied.");
  };
  const label = copied === address ? "Link copied" : "Copy link";
  return (
    <div className="line">
      <Box component="h1" fz="lg" style={{ overflowWrap: "anywhere" }}>
        {heading}
      </Box>
      <Tooltip label={label}>
        <ActionIcon size="md" aria-label={label} onClick={() => void copy()}>
          {copied === address ? <IconCheck size={16} /> : <IconLink size={16} />}
        </ActionIcon>
      </Tooltip>
    </div>
  );
}

/** A link to a place; it opens in this window without another load. */
export function PlaceLink({ place, children }: { place: Place; children: ReactNode }) {
  const open = (event: MouseEvent) => {
    if (event.ctrlKey || event.metaKey || event.shiftKey) return; // in a window of its own
    event.preventDefault();
    openPlace(place.page, place.item);
  };
  return (
    <Anchor href={addressOf(place)} c="inherit" underline="hover" inherit onClick={open}>
      {children}
    </Anchor>
  );
}

import { ActionIcon, Button, Menu } from "@mantine/core";
import { IconChevronDown, IconDownload } from "@tabler/icons-react";
import type { ReactNode } from "react";
import { pngOf, saveFile } from "../ui/save-file";
import { type Picture, pictureSvg } from "./picture";

/** The present picture; undefined before the first. */
export type TakePicture = () => Picture | undefined;

interface PictureMenuProps {
  take: TakePicture;
  /** The name of the picture, if there are several. */
  name?: string;
  /** Tools of a panel, above the picture; the button has a word then. */
  tools?: ReactNode;
  /** More that can be kept, below the picture. */
  children?: ReactNode;
}

/** Save the contents of a panel as a picture with titled axes and events. */
export function PictureMenu({ take, name, tools, children }: PictureMenuProps) {
  const keep = async (kind: "png" | "svg") => {
    const picture = take();
    if (!picture) return;
    const svg = pictureSvg(picture);
    const content = kind === "png" ? await pngOf(svg) : new Blob([svg], { type: "image/svg+xml" });
    saveFile(`${picture.stem}.${kind}`, content);
  };
  return (
    <Menu position="bottom-end">
      <Menu.Target>
        {tools ? (
          <Button size="compact-sm" rightSection={<IconChevronDown size={12} />}>
            Tools
          </Button>
        ) : (
          <ActionIcon
            size={26}
            variant="default"
            aria-label={name ? `Export: ${name}` : "Export"}
            title="Save what is shown as a file"
          >
            <IconDownload size={15} />
          </ActionIcon>
        )}
      </Menu.Target>
      <Menu.Dropdown>
        {tools}
        <Menu.Label>Picture, with titled axes</Menu.Label>
        <Menu.Item onClick={() => keep("png")}>PNG</Menu.Item>
        <Menu.Item onClick={() => keep("svg")}>SVG</Menu.Item>
        {children}
      </Menu.Dropdown>
    </Menu>
  );
}

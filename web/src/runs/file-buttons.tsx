import { Button } from "@mantine/core";
import { IconBrandPython, IconFileText } from "@tabler/icons-react";

/** Opens the report of a run or a campaign in a tab of its own. */
export function ReportButton({ files, title }: { files: string; title?: string }) {
  return (
    <Button
      variant="filled"
      component="a"
      href={`${files}/report`}
      target="_blank"
      size="xs"
      leftSection={<IconFileText size={15} />}
      title={title}
    >
      Report
    </Button>
  );
}

/** Downloads the script that repeats a run or a campaign. */
export function ScriptButton({ files, title }: { files: string; title: string }) {
  return (
    <Button
      component="a"
      href={`${files}/script`}
      download
      size="xs"
      leftSection={<IconBrandPython size={15} />}
      title={title}
    >
      Repeat as Python script
    </Button>
  );
}

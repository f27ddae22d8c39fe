import { ActionIcon, Menu } from "@mantine/core";
import { IconCode } from "@tabler/icons-react";
import type { LogEntry } from "../../api/types";
import { announce } from "../../bench/announce";
import { asCode, LANGUAGES, type Language } from "../../bench/as-code";
import { useBench } from "../../stream/bench-store";
import { copyText } from "../../ui/copy-text";

/** Copy the command behind an event, for a shell or for Python. */
export function CopyMenu({ event }: { event: LogEntry }) {
  const copy = (language: Language) => async () => {
    const text = codeOf(event)[language];
    if (text === undefined) return;
    await copyText(text);
    announce("Command copied.");
  };
  return (
    <Menu position="bottom-end">
      <Menu.Target>
        <ActionIcon size="sm" aria-label={`Copy: ${event.text}`} title="Copy this command for a script">
          <IconCode size={14} />
        </ActionIcon>
      </Menu.Target>
      <Menu.Dropdown>
        {(Object.keys(codeOf(event)) as Language[]).map((language) => (
          <Menu.Item key={language} onClick={copy(language)}>
            {LANGUAGES[language]}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}

function codeOf(event: LogEntry) {
  const { bench } = useBench.getState();
  if (!bench) return {};
  const address = new URL(".", document.baseURI).href;
  return asCode(event, { address, bench: bench.id, scenario: bench.scenario_id, samples: bench.samples });
}

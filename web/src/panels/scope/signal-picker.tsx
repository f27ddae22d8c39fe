import { ActionIcon, Checkbox, Popover, ScrollArea, Stack, Text, TextInput, Tooltip } from "@mantine/core";
import { IconPlus } from "@tabler/icons-react";
import { useMemo, useState } from "react";
import { useBench } from "../../stream/bench-store";
import { groupBy } from "../../ui/group-by";
import { unitText } from "../../ui/unit-scale";

interface SignalPickerProps {
  chosen: string[];
  onChange(signals: string[]): void;
  isLog: boolean;
  onLog(isLog: boolean): void;
}

/** Every signal of the bench by block with its meaning, a search, and the scale. */
export function SignalPicker({ chosen, onChange, isLog, onLog }: SignalPickerProps) {
  const signals = useBench((s) => s.bench?.signals);
  const [query, setQuery] = useState("");
  const groups = useMemo(() => {
    const wanted = query.toLowerCase();
    const found = signals?.filter(({ name, meaning }) => `${name} ${meaning}`.toLowerCase().includes(wanted));
    return groupBy(found ?? [], ({ name }) => name.split(".")[0]);
  }, [signals, query]);

  return (
    <Popover position="bottom-start" width={360} trapFocus>
      <Popover.Target>
        <Tooltip label="Add or remove signals">
          <ActionIcon size={24} aria-label="Choose signals">
            <IconPlus size={15} />
          </ActionIcon>
        </Tooltip>
      </Popover.Target>
      <Popover.Dropdown>
        <TextInput
          placeholder="Search signals"
          aria-label="Search signals"
          value={query}
          onChange={(e) => setQuery(e.currentTarget.value)}
          mb="sm"
        />
        <Checkbox
          mb="sm"
          label="Logarithmic scale, of magnitudes"
          checked={isLog}
          onChange={(e) => onLog(e.currentTarget.checked)}
        />
        <ScrollArea.Autosize mah={340} type="auto" offsetScrollbars>
          {groups.map(([block, list]) => (
            <Stack key={block} gap={4} mb="sm">
              <Text size="xs" fw={600} c="dimmed">
                {block.replaceAll("_", " ")}
              </Text>
              {list.map((signal) => (
                <Checkbox
                  key={signal.name}
                  checked={chosen.includes(signal.name)}
                  label={`${signal.name.slice(block.length + 1)}${unitText(signal.unit) ? ` · ${unitText(signal.unit)}` : ""}`}
                  description={signal.meaning}
                  onChange={(e) =>
                    onChange(
                      e.currentTarget.checked
                        ? [...chosen, signal.name]
                        : chosen.filter((name) => name !== signal.name),
                    )
                  }
                />
              ))}
            </Stack>
          ))}
          {groups.length === 0 && (
            <Text size="xs" c="dimmed">
              No signal of this bench matches.
            </Text>
          )}
        </ScrollArea.Autosize>
      </Popover.Dropdown>
    </Popover>
  );
}

import { Button, Checkbox, Group } from "@mantine/core";
import { useState } from "react";
import type { Document, Parameter } from "../../api/types";
import { showPanel } from "../../bench/dock";
import { send } from "../../bench/send";
import { type Instance, parameterValue } from "./instances";
import { ParameterRow } from "./parameter-row";
import { parameterTitle } from "./parameter-title";

interface ParameterListProps {
  instance: Instance;
  parameters: Parameter[];
  document: Document;
}

type Values = Record<string, unknown>;

/** The parameters of a block: change at once, or collect changes and apply them in one tick. */
export function ParameterList({ instance, parameters, document }: ParameterListProps) {
  const [collect, setCollect] = useState(false);
  const [staged, setStaged] = useState<Values>({});
  const current = (name: string) => parameterValue(document, instance, name);
  const shown = parameters.filter((p) => p.type !== "list" && p.type !== "table");

  const apply = async (values: Values) => {
    const named = parameters.filter((p) => `${instance.path}.${p.name}` in values).map(parameterTitle);
    if (await send({ set: values }, `${named.join(", ")} set`)) setStaged({});
  };

  const change = (parameter: Parameter, value: unknown) => {
    const path = `${instance.path}.${parameter.name}`;
    if (collect) setStaged({ ...staged, [path]: value });
    else void apply({ [path]: value });
  };

  if (shown.length === 0) return <p className="note">This block has no parameters.</p>;
  const count = Object.keys(staged).length;
  return (
    <>
      <div style={{ borderTop: "1px solid var(--line)" }}>
        {shown.map((parameter) => {
          const path = `${instance.path}.${parameter.name}`;
          const value = path in staged ? staged[path] : (current(parameter.name) ?? parameter.default);
          return (
            <ParameterRow
              key={parameter.name}
              parameter={parameter}
              value={value}
              staged={path in staged}
              onChange={(next) => change(parameter, next)}
            />
          );
        })}
      </div>
      <Group gap="sm" mt={12}>
        <Checkbox
          label="Collect changes, apply them in one tick"
          checked={collect}
          onChange={(e) => setCollect(e.currentTarget.checked)}
        />
        {count > 0 && (
          <Button variant="filled" onClick={() => apply(staged)}>
            Apply {count} in one tick
          </Button>
        )}
        <Button onClick={() => showPanel("sets")}>Sets…</Button>
      </Group>
    </>
  );
}

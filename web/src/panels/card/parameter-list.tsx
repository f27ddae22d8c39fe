import { Button, Checkbox, Group } from "@mantine/core";
import { Fragment, useState } from "react";
import { useServed } from "../../api/me";
import type { Document, Parameter } from "../../api/types";
import { showPanel } from "../../bench/dock";
import { send } from "../../bench/send";
import { type Instance, parameterValue } from "./instances";
import { ParameterRow } from "./parameter-row";
import { parameterTitle } from "./parameter-title";

/** Parameters of a block on the bench, with a title where several blocks are listed. */
interface BlockParameters {
  title?: string;
  instance: Instance;
  parameters: Parameter[];
}

interface ParameterListProps {
  blocks: BlockParameters[];
  document: Document;
}

type Values = Record<string, unknown>;

/** The parameters of blocks: change at once, or collect changes and apply them in one tick. */
export function ParameterList({ blocks, document }: ParameterListProps) {
  const served = useServed();
  const [collect, setCollect] = useState(false);
  const [staged, setStaged] = useState<Values>({});
  const rows = blocks.map((one) => ({
    ...one,
    shown: one.parameters.filter((p) => p.type !== "list" && p.type !== "table"),
  }));

  const apply = async (values: Values) => {
    const named = blocks.flatMap(({ instance, parameters }) =>
      parameters.filter((p) => `${instance.path}.${p.name}` in values).map(parameterTitle),
    );
    if (await send({ set: values }, `${named.join(", ")} set`)) setStaged({});
  };

  const change = (path: string, value: unknown) => {
    if (collect) setStaged({ ...staged, [path]: value });
    else void apply({ [path]: value });
  };

  if (rows.every(({ shown }) => shown.length === 0)) return <p className="note">This block has no parameters.</p>;
  const count = Object.keys(staged).length;
  return (
    <>
      {rows.map(({ title, instance, shown }) => (
        <Fragment key={instance.id}>
          {title && <h2>{title}</h2>}
          <div style={{ borderTop: "1px solid var(--line)" }}>
            {shown.map((parameter) => {
              const path = `${instance.path}.${parameter.name}`;
              const current = parameterValue(document, instance, parameter.name) ?? parameter.default;
              return (
                <ParameterRow
                  key={parameter.name}
                  parameter={parameter}
                  value={path in staged ? staged[path] : current}
                  staged={path in staged}
                  onChange={(next) => change(path, next)}
                />
              );
            })}
          </div>
        </Fragment>
      ))}
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
        {served && <Button onClick={() => showPanel("sets")}>Sets…</Button>}
      </Group>
    </>
  );
}

import { Menu } from "@mantine/core";
import { IconGitBranch, IconPlayerPlayFilled } from "@tabler/icons-react";
import { fits } from "../api/fits";
import type { Bench } from "../api/types";
import { slotMates, useCatalog } from "../api/use-catalog";
import { titleOf } from "../bench/flag-words";
import { goOn, goOnHaving } from "../bench/past";
import { send } from "../bench/send";
import { StripButton } from "./strip-button";

/** The branches that can begin at the moment shown: the same again, or with one change. The bench itself is left as it is. */
export function BranchMenu({ bench }: { bench: Bench }) {
  useCatalog(); // the titles come with it
  const others = slotMates(bench.controller, bench.controllers).filter((name) => name !== bench.controller);
  return (
    <Menu position="top-end">
      <Menu.Target>
        <StripButton
          variant={bench.origin?.is_past ? "filled" : "default"}
          icon={<IconGitBranch size={16} />}
          label="Branch here"
        />
      </Menu.Target>
      <Menu.Dropdown>
        <Menu.Item leftSection={<IconPlayerPlayFilled size={14} />} onClick={() => void goOn("as it was")}>
          Go on as it was
        </Menu.Item>
        {bench.faults.map(({ name }) => (
          <Menu.Item
            key={name}
            onClick={() =>
              void goOn(`without ${titleOf("faults", name)}`, () =>
                send({ heal: [name] }, `${titleOf("faults", name)} healed`),
              )
            }
          >
            Without {titleOf("faults", name).toLowerCase()}
          </Menu.Item>
        ))}
        {others.length > 0 && <Menu.Label>With another controller from here</Menu.Label>}
        {others.map((name) => (
          <Menu.Item
            key={name}
            onClick={() => void goOn(`with ${titleOf("control", name)}`, () => send({ switch: name }))}
          >
            With {titleOf("control", name)}
          </Menu.Item>
        ))}
        <DiagnoserItems bench={bench} />
      </Menu.Dropdown>
    </Menu>
  );
}

/** The diagnosers that the bench lacks; a chosen one sees the whole run from tick 0. */
function DiagnoserItems({ bench }: { bench: Bench }) {
  const { blocks } = useCatalog();
  const there = new Set([...Object.keys(bench.diagnosers), ...Object.values(bench.diagnosers).map(({ kind }) => kind)]);
  const missing = blocks.filter((b) => b.family === "diagnose" && fits(b, bench.axes) && !there.has(b.name));
  if (missing.length === 0) return null;
  return (
    <>
      <Menu.Label>With another diagnoser from tick 0</Menu.Label>
      {missing.map(({ name, title }) => (
        <Menu.Item
          key={name}
          onClick={() => void goOnHaving(`with ${title}`, { [`diagnosers.${name}`]: { kind: name } })}
        >
          With {title}
        </Menu.Item>
      ))}
    </>
  );
}

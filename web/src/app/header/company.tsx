import { Box, Menu, Popover, UnstyledButton } from "@mantine/core";
import { IconSteeringWheel, IconUsers } from "@tabler/icons-react";
import { useMay, useMe } from "../../api/me";
import type { Company } from "../../api/types";
import { changeDriver, drivingWords, nameOf, useCompany } from "../../bench/driving";
import { formatCount } from "../../ui/format";
import styles from "./header.module.css";

/** The driver and the onlookers, if there are several people; a menu for everyone who may drive. */
export function CompanyMenu() {
  const company = useCompany();
  const me = useMe((s) => s.me?.id);
  const drives = useMay("drive");
  if (!company) return null;
  const words = drivingWords(company, me);
  const isDriver = company.driver?.id === me;
  const button = (
    <UnstyledButton
      className={`line ${styles.company}`}
      data-driver={company.is_leased && isDriver}
      title="Who is here"
    >
      {company.is_leased ? <IconSteeringWheel size={17} /> : <IconUsers size={17} />}
      <Box component="span" className="cut" maw="15ch">
        {words}
      </Box>
    </UnstyledButton>
  );
  if (!drives || !company.is_leased)
    return (
      <Popover width={280} position="bottom-end" trapFocus returnFocus>
        <Popover.Target>{button}</Popover.Target>
        <Popover.Dropdown p={4}>
          <Here company={company} />
        </Popover.Dropdown>
      </Popover>
    );
  return (
    <Menu width={280} position="bottom-end">
      <Menu.Target>{button}</Menu.Target>
      <Menu.Dropdown>
        <Here company={company} />
        <Menu.Divider />
        {isDriver ? <Driver company={company} /> : <Others company={company} />}
      </Menu.Dropdown>
    </Menu>
  );
}

function Here({ company }: { company: Company }) {
  const { driver, drivers, watching, more_watching, links } = company;
  const names = [...watching, ...(more_watching > 0 ? [`${more_watching} more`] : [])];
  const people = [
    ...drivers.map((one) => [nameOf(one), one.id === driver?.id && "drives"] as const),
    ...(names.length > 0 ? [[names.join(", "), names.length === 1 ? "looks on" : "look on"] as const] : []),
    ...(links > 0 ? [[formatCount(links, "page"), "by links to watch"] as const] : []),
  ];
  return (
    <>
      <Box component="p" className="note" p="2px 12px">
        Who is here
      </Box>
      {people.map(([name, does]) => (
        <Box component="p" key={name} className="note" p="2px 12px" style={{ overflowWrap: "anywhere" }}>
          <Box component="b" c="var(--text)" fw={560}>
            {name}
          </Box>{" "}
          {does}
        </Box>
      ))}
    </>
  );
}

/** The items of the driver. */
function Driver({ company }: { company: Company }) {
  const me = useMe((s) => s.me);
  const others = company.drivers.filter(({ id }) => id !== me?.id);
  return (
    <>
      {others.map((one) => (
        <Menu.Item key={one.id} onClick={() => changeDriver("hand_over", one)}>
          Hand over to {one.id === "teacher" ? "the teacher" : one.name}
        </Menu.Item>
      ))}
      <Menu.Item onClick={() => changeDriver("leave")}>
        Drive no longer
        <small>The next person who does something drives</small>
      </Menu.Item>
    </>
  );
}

/** The items of the others. */
function Others({ company }: { company: Company }) {
  const me = useMe((s) => s.me);
  const teaches = useMay("teach");
  const { driver, asking, lent_by } = company;
  if (!driver) return <Menu.Item onClick={() => changeDriver("ask")}>Drive this bench</Menu.Item>;
  const asked = asking.some(({ id }) => id === me?.id);
  return (
    <>
      <Menu.Item disabled={asked} onClick={() => changeDriver("ask")}>
        {asked ? "You have asked to drive" : "Ask to drive"}
        <small>{nameOf(driver)} receives your request and can hand over</small>
      </Menu.Item>
      {(teaches || lent_by === me?.id) && (
        <Menu.Item onClick={() => changeDriver("take")}>{teaches ? "Take the bench" : "Take the bench back"}</Menu.Item>
      )}
    </>
  );
}

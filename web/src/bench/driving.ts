import { classes } from "../api/classes";
import { useMe } from "../api/me";
import type { Company, DrivingTurn } from "../api/types";
import { useBench } from "../stream/bench-store";
import { announce } from "./announce";
import { showing } from "./send";

type Somebody = Company["drivers"][number];

/** The people at the bench on the page; undefined while there is only one. */
export const useCompany = (): Company | undefined => useBench((s) => s.bench?.company ?? undefined);

/** The name of a person for the others. */
export const nameOf = ({ id, name }: Somebody): string => (id === "teacher" ? "The teacher" : name);

/** The driver in words; or the number of onlookers where no one else may drive. */
export function drivingWords(company: Company, me: string | undefined): string {
  const { is_leased, driver, watching, more_watching, links } = company;
  if (!is_leased) {
    const onlookers = watching.length + more_watching + links;
    return onlookers === 1 ? "1 looks on" : `${onlookers} look on`;
  }
  if (!driver) return "Nobody drives";
  return driver.id === me ? "You drive" : `${nameOf(driver)} drives`;
}

/** Ask for the bench on the page, hand it over or take it back. */
export const changeDriver = showing(async (what: DrivingTurn, to?: Somebody) => {
  const id = useBench.getState().bench?.id;
  if (!id) return;
  const { company } = await classes.drive(id, what, to?.id);
  if (company) announce(`${drivingWords(company, useMe.getState().me?.id)}.`);
});

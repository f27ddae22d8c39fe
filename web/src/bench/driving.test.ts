import { expect, test } from "vitest";
import type { Company } from "../api/types";
import { drivingWords } from "./driving";

const ADA = { id: "a", name: "Ada" };
const TEACHER = { id: "teacher", name: "teacher" };
const company = (fields: Partial<Company>): Company => ({
  is_leased: true,
  driver: ADA,
  drivers: [ADA, TEACHER],
  asking: [],
  lent_by: "",
  watching: [],
  more_watching: 0,
  links: 0,
  ...fields,
});

test("who drives is said from where one stands", () => {
  expect(drivingWords(company({}), "a")).toBe("You drive");
  expect(drivingWords(company({}), "teacher")).toBe("Ada drives");
  expect(drivingWords(company({ driver: TEACHER }), "a")).toBe("The teacher drives");
  expect(drivingWords(company({ driver: null }), "a")).toBe("Nobody drives");
});

test("where one alone may drive, it is said how many look on", () => {
  const alone = { is_leased: false, driver: null };
  expect(drivingWords(company({ ...alone, links: 1 }), "a")).toBe("1 looks on");
  expect(drivingWords(company({ ...alone, watching: ["Ben", "Cy"], more_watching: 3, links: 1 }), "a")).toBe(
    "6 look on",
  );
});

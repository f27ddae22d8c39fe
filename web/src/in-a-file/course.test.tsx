import { fireEvent, screen, within } from "@testing-library/react";
import { beforeEach, expect, it } from "vitest";
import { Course, type CourseApi, courseAround } from "./course";
import type { FileQuestion } from "./file-document";
import { QuestionList, shareOf } from "./question-list";

/** A learning system that keeps all values. */
class StubCourse implements CourseApi {
  readonly values: Record<string, string> = { "cmi.core.lesson_status": "not attempted" };
  readonly calls: string[] = [];
  LMSInitialize = () => this.call("LMSInitialize");
  LMSGetValue = (name: string) => this.values[name] ?? "";
  LMSCommit = () => this.call("LMSCommit");
  LMSFinish = () => this.call("LMSFinish");
  LMSSetValue = (name: string, value: string) => {
    this.values[name] = value;
    return this.call("LMSSetValue");
  };

  private call(name: string): string {
    this.calls.push(name);
    return "true";
  }
}

const question = (value: number, points: number): FileQuestion => ({
  heading: `Number ${value}`,
  text: "",
  question: `What is ${value}?`,
  points,
  tries: 2,
  value,
  unit: "Hz",
  within: 0.02,
  within_absolute: 0,
  partly: { within: 0.1, share: 0.5 },
});
const sheet = { title: "Lab", intro: "", questions: [question(100, 3), question(-4, 1)], rest: "1 other step" };

beforeEach(() => document.body.replaceChildren());

it("finds the course in a frame above the page, or above the window that opened it", () => {
  const API = new StubCourse();
  const top = { API } as const;
  const middle = { parent: top };
  expect(courseAround({ parent: middle })).toBe(API);
  expect(courseAround({ parent: {}, opener: middle })).toBe(API);
  const alone: { parent?: unknown } = {};
  alone.parent = alone;
  expect(courseAround(alone as never)).toBeUndefined();
});

it("does not fail where the frames above are of another host", () => {
  const foreign = Object.defineProperty({}, "API", {
    get: () => {
      throw new Error("blocked");
    },
  });
  expect(courseAround({ parent: foreign })).toBeUndefined();
});

it("gives the course the points of a sheet in percent, and the status when all questions are closed", () => {
  const api = new StubCourse();
  const course = new Course(api, true);
  expect(api.values["cmi.core.lesson_status"]).toBe("incomplete");
  document.body.append(new QuestionList(sheet, (percent, isDone) => course.score(percent, isDone)).root);
  const answer = (name: string, value: string) => {
    const box = screen.getByRole("textbox", { name });
    fireEvent.change(box, { target: { value } });
    fireEvent.click(within(box.parentElement as HTMLElement).getByRole("button", { name: "Check" }));
  };
  answer("What is 100?", "101.5");
  expect(api.values["cmi.core.score.raw"]).toBe("75");
  expect(api.values["cmi.core.lesson_status"]).toBe("incomplete");
  answer("What is -4?", "many");
  expect(screen.getByText("A number, such as 2.48 or -3e2")).toBeTruthy();
  answer("What is -4?", "4");
  answer("What is -4?", "-4.3");
  expect(api.values["cmi.core.score.raw"]).toBe("87.5");
  expect(api.values["cmi.core.lesson_status"]).toBe("completed");
  course.leave();
  course.leave();
  expect(api.calls.filter((call) => call === "LMSFinish")).toHaveLength(1);
});

it("says that a bench without questions is completed once it is open, and keeps the status of an earlier visit", () => {
  const fresh = new StubCourse();
  new Course(fresh, false);
  expect(fresh.values["cmi.core.lesson_status"]).toBe("completed");
  const again = new StubCourse();
  again.values["cmi.core.lesson_status"] = "passed";
  new Course(again, true);
  expect(again.values["cmi.core.lesson_status"]).toBe("passed");
});

it("takes a number within its tolerance, at its ends too, and gives a share within the wider tolerance", () => {
  const asked = question(100, 1);
  expect([98, 102, 97.9, 110, 111].map((given) => shareOf(asked, given))).toEqual([1, 1, 0.5, 0.5, 0]);
  expect(shareOf({ ...asked, value: 0, within_absolute: 0.1, partly: null }, -0.1)).toBe(1);
});

/** The functions of a course by SCORM 1.2 that a page uses. */
export interface CourseApi {
  LMSInitialize(nothing: ""): string;
  LMSGetValue(name: string): string;
  LMSSetValue(name: string, value: string): string;
  LMSCommit(nothing: ""): string;
  LMSFinish(nothing: ""): string;
}

type Frame = { API?: CourseApi; parent?: Frame; opener?: Frame | null };

/** Frames above a page that are asked for a course. */
const MOST_FRAMES = 8;

/** Find the course around a page: in the frames above it, then above the window that opened it. */
export function courseAround(page: Frame): CourseApi | undefined {
  return above(page) ?? (page.opener ? above(page.opener) : undefined);
}

function above(page: Frame): CourseApi | undefined {
  let frame: Frame | undefined = page;
  for (let k = 0; frame && k < MOST_FRAMES; k += 1) {
    try {
      if (frame.API) return frame.API;
    } catch {
      return undefined; // a frame of another host
    }
    frame = frame.parent === frame ? undefined : frame.parent;
  }
  return undefined;
}

/** The course around a page, which takes the status and the points in percent. */
export class Course {
  private readonly api: CourseApi;
  private isOpen: boolean;

  constructor(api: CourseApi, hasQuestions: boolean) {
    this.api = api;
    this.isOpen = api.LMSInitialize("") === "true";
    const status = this.isOpen ? api.LMSGetValue("cmi.core.lesson_status") : "";
    if (["", "not attempted", "unknown"].includes(status)) this.tell(hasQuestions ? "incomplete" : "completed");
  }

  /** Tell the points in percent. */
  score(percent: number, isDone: boolean): void {
    if (!this.isOpen) return;
    this.api.LMSSetValue("cmi.core.score.min", "0");
    this.api.LMSSetValue("cmi.core.score.max", "100");
    this.api.LMSSetValue("cmi.core.score.raw", String(Math.round(percent * 100) / 100));
    this.tell(isDone ? "completed" : "incomplete");
  }

  /** End the visit. */
  leave(): void {
    if (this.isOpen) this.api.LMSFinish("");
    this.isOpen = false;
  }

  private tell(status: string): void {
    if (!this.isOpen) return;
    this.api.LMSSetValue("cmi.core.lesson_status", status);
    this.api.LMSCommit("");
  }
}

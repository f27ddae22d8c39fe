import { button, element, write } from "./dom";
import type { FileQuestion, FileSheet } from "./file-document";

/** The questions of a lab sheet that a file can judge: numbers, within their tolerance. */
export class QuestionList {
  readonly root = element("section", { className: "panel list questions" });
  private readonly earned: number[];
  private readonly open: boolean[];
  private readonly sheet: FileSheet;
  private readonly onScore: (percent: number, isDone: boolean) => void;

  /** `onScore` takes the points in percent, and whether all questions are closed, after each answer. */
  constructor(sheet: FileSheet, onScore: (percent: number, isDone: boolean) => void) {
    this.sheet = sheet;
    this.onScore = onScore;
    this.earned = sheet.questions.map(() => 0);
    this.open = sheet.questions.map(() => true);
    this.root.append(element("h2", {}, sheet.title), element("p", { className: "text" }, sheet.intro));
    this.root.append(...sheet.questions.map((question, i) => this.row(question, i)));
    if (sheet.rest) this.root.append(element("p", { className: "note" }, sheet.rest));
  }

  private row(question: FileQuestion, i: number): HTMLElement {
    const { heading, text, unit, points, tries } = question;
    const answer = element("input", { type: "text", inputMode: "decimal", ariaLabel: question.question });
    const verdict = element("p", { className: "result", role: "status" });
    let left = tries;
    const check = button("Check", () => {
      const given = Number(answer.value.trim().replace("−", "-"));
      if (answer.value.trim() === "" || !Number.isFinite(given)) {
        write(verdict, "A number, such as 2.48 or -3e2");
        return;
      }
      left -= 1;
      const share = shareOf(question, given);
      this.earned[i] = Math.max(this.earned[i], share * points);
      this.open[i] = left > 0 && share < 1;
      answer.disabled = check.disabled = !this.open[i];
      const word = share === 1 ? "✓ Right" : share > 0 ? "Partly right" : "✗ Wrong";
      write(verdict, this.open[i] ? `${word}, ${left} left` : word);
      verdict.dataset.same = String(share === 1);
      this.tell();
    });
    const line = element("div", { className: "line" }, answer, unit, check, element("small", {}, `${points} points`));
    const asked = [element("p", { className: "text" }, text), element("p", {}, question.question)];
    return element("div", {}, element("h3", {}, heading), ...asked, line, verdict);
  }

  private tell(): void {
    const most = this.sheet.questions.reduce((sum, { points }) => sum + points, 0);
    const points = this.earned.reduce((sum, one) => sum + one, 0);
    this.onScore((100 * points) / most, !this.open.includes(true));
  }
}

/** The share of the points that a number earns. */
export function shareOf({ value, within, within_absolute: absolute, partly }: FileQuestion, given: number): number {
  const miss = Math.abs(given - value);
  if (miss <= Math.max(within * Math.abs(value), absolute)) return 1;
  return partly && miss <= partly.within * Math.abs(value) ? partly.share : 0;
}

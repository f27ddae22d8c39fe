import { Button } from "@mantine/core";
import { ApiError } from "../api/client";
import { isInFrame } from "../api/session";
import type { Me } from "../api/types";
import { EmptyState } from "../ui/empty-state";

/** Replaces the page after the end of a session. */
export function Ended({ role }: { role: Me["role"] }) {
  const isStudent = role === "student" || isInFrame();
  const join = (
    <Button variant="filled" size="sm" component="a" href="./join">
      Join a class
    </Button>
  );
  return (
    <main className="page">
      <EmptyState
        title={isStudent ? "Your session has ended" : "The link to watch has ended"}
        action={isStudent && !isInFrame() && join}
      >
        {isInFrame() ? IN_FRAME : isStudent ? CLOSED : "Ask for a new one to continue."}
      </EmptyState>
    </main>
  );
}

const IN_FRAME =
  "You opened the exercise in another place, the class is over, or the teacher has sent you away. Open the exercise again from your course.";
const CLOSED = "The class is over, or the teacher has sent you away. Your bench is closed.";

/** Replaces the page after a refused launch from a learning platform. */
export function NotLaunched({ error }: { error: unknown }) {
  const { message, hint } = error instanceof ApiError ? error.body : { message: String(error), hint: "" };
  return (
    <main className="page">
      <EmptyState title="The bench did not open">
        {sentence(message)} {sentence(hint || "Open the exercise again from your course")}
      </EmptyState>
    </main>
  );
}

const sentence = (text: string): string =>
  `${text.slice(0, 1).toUpperCase()}${text.slice(1)}${/[.!?]$/.test(text) ? "" : "."}`;

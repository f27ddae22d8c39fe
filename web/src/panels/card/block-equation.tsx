import { Popover, UnstyledButton } from "@mantine/core";
import type { Equation } from "../../api/types";
import { Formula } from "../../ui/formula";
import { Prose } from "../../ui/prose";
import styles from "./card.module.css";

/** An equation with its number; where the printed one is wrong, a mark opens what was printed and why not. */
export function BlockEquation({ equation }: { equation: Equation }) {
  return (
    <figure className={styles.equation}>
      <Formula latex={equation.latex} />
      <figcaption>
        {equation.label && <span>{equation.label.replaceAll("_", " ")}</span>}
        {equation.source && <span>({equation.source})</span>}
        {equation.printed && (
          <Popover width={360} position="bottom-end">
            <Popover.Target>
              <UnstyledButton className={styles.erratum} aria-label="Erratum: the printed equation differs">
                erratum
              </UnstyledButton>
            </Popover.Target>
            <Popover.Dropdown className={styles.printed}>
              <h3>As printed</h3>
              <Printed text={equation.printed} />
              <h3>As it works</h3>
              <Formula latex={equation.latex} />
              {equation.why && (
                <>
                  <h3>Why</h3>
                  <p>
                    <Prose text={equation.why} />
                  </p>
                </>
              )}
            </Popover.Dropdown>
          </Popover>
        )}
      </figcaption>
    </figure>
  );
}

/** What was printed is an equation, or words about one. */
function Printed({ text }: { text: string }) {
  return /[\\^_=]/.test(text) ? (
    <Formula latex={text} />
  ) : (
    <p>
      <Prose text={text} />
    </p>
  );
}

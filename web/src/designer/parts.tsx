import styles from "./designer.module.css";

/** The colours of the parts in every drawing. */
export const COLOURS = {
  shuttle: "#56b4e9",
  beam: "#e69f00",
  stator: "var(--strong-line)",
  driveFrame: "#cc79a7",
  senseFrame: "#009e73",
};

/** The parts of a drawing in words after their colours; a part without a colour is drawn as an outline. */
export function Parts({ parts }: { parts: readonly (readonly [words: string, colour?: string])[] }) {
  return (
    <ul className={styles.parts}>
      {parts.map(([words, background]) => (
        <li key={words}>
          <i style={background ? { background } : { border: "1.5px solid var(--text)" }} />
          {words}
        </li>
      ))}
    </ul>
  );
}

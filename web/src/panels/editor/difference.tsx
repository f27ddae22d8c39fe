import { python } from "@codemirror/lang-python";
import { syntaxHighlighting } from "@codemirror/language";
import { unifiedMergeView } from "@codemirror/merge";
import { EditorState } from "@codemirror/state";
import { EditorView, lineNumbers } from "@codemirror/view";
import { Box, Button } from "@mantine/core";
import { useEffect, useRef } from "react";
import type { UnitVersion } from "../../bench/unit-draft";
import { COLOURS, LOOK, NONCE } from "./code-look";
import styles from "./editor.module.css";
import { timeOf } from "./versions";

interface DifferenceProps {
  version: UnitVersion;
  source: string;
  onBack(): void;
  onClose(): void;
}

/** A version and the text of now: removed lines above new lines. */
export function Difference({ version, source, onBack, onClose }: DifferenceProps) {
  const place = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (!place.current) return;
    const view = new EditorView({
      parent: place.current,
      state: EditorState.create({
        doc: source,
        extensions: [
          NONCE,
          lineNumbers(),
          python(),
          syntaxHighlighting(COLOURS),
          LOOK,
          EditorView.lineWrapping,
          EditorState.readOnly.of(true),
          EditorView.contentAttributes.of({ "aria-label": "Difference", tabindex: "0" }),
          unifiedMergeView({
            original: version.source,
            mergeControls: false,
            collapseUnchanged: { margin: 3, minSize: 6 },
          }),
        ],
      }),
    });
    return () => view.destroy();
  }, [version, source]);
  return (
    <section className={`column ${styles.difference}`} aria-label="Difference">
      <Box component="header" className="row" p="6px 12px" style={{ borderBottom: "1px solid var(--line)" }}>
        <Box component="span" flex="1 1 24ch">
          From the version of {timeOf(version)} to the text of now
          {version.source === source && ": they are the same"}
        </Box>
        <Button variant="filled" onClick={onBack} disabled={version.source === source}>
          Back to that version
        </Button>
        <Button onClick={onClose}>Close</Button>
      </Box>
      <div ref={place} className={styles.code} />
    </section>
  );
}

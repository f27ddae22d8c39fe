import { autocompletion, type CompletionContext, closeBrackets, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { localCompletionSource, python } from "@codemirror/lang-python";
import { bracketMatching, indentOnInput, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { EditorState } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers, placeholder } from "@codemirror/view";
import { useEffect, useRef } from "react";
import type { BlockCard, UnitMistake } from "../../api/types";
import { COLOURS, LOOK, NONCE } from "./code-look";
import styles from "./editor.module.css";
import { spanOf } from "./span";

/** Escape closes the list of words of the text, and not the drawer around it. */
const ATTRIBUTES = {
  "aria-label": "Text of the unit",
  "data-mantine-stop-propagation": "true",
  spellcheck: "false",
  tabindex: "0",
};

interface CodeProps {
  source: string;
  onChange(source: string): void;
  /** The mistakes in the text, each with its place; undefined while it is checked. */
  mistakes: UnitMistake[] | undefined;
  /** The unit that passed last: the fields of x and p. */
  card: BlockCard | undefined;
}

/** The text of a unit: Python in colours, its mistakes underlined. */
export function Code({ source, onChange, mistakes, card }: CodeProps) {
  const place = useRef<HTMLDivElement>(null);
  const view = useRef<EditorView>(undefined);
  const known = useRef({ onChange, card });
  known.current = { onChange, card };

  useEffect(() => {
    if (!place.current) return;
    const made = new EditorView({
      parent: place.current,
      state: EditorState.create({
        extensions: [
          NONCE,
          lineNumbers(),
          lintGutter(),
          history(),
          drawSelection(),
          bracketMatching(),
          closeBrackets(),
          indentOnInput(),
          indentUnit.of("    "),
          highlightActiveLine(),
          EditorView.lineWrapping,
          python(),
          syntaxHighlighting(COLOURS),
          LOOK,
          EditorView.contentAttributes.of(ATTRIBUTES),
          placeholder("Type or paste a unit, or choose a text under Start from."),
          autocompletion({ override: [(at) => fieldsOf(at, known.current.card), localCompletionSource] }),
          keymap.of([...defaultKeymap, ...historyKeymap, ...completionKeymap, ...lintKeymap, indentWithTab]),
          EditorView.updateListener.of((update) => {
            if (update.docChanged) known.current.onChange(update.state.doc.toString());
          }),
        ],
      }),
    });
    view.current = made;
    return () => made.destroy();
  }, []);

  useEffect(() => {
    const { current } = view;
    if (!current || current.state.doc.toString() === source) return;
    current.dispatch({ changes: { from: 0, to: current.state.doc.length, insert: source } });
  }, [source]);

  useEffect(() => {
    const { current } = view;
    if (!current || !mistakes) return;
    const { doc } = current.state;
    const found = mistakes.map((one) => ({ ...spanOf(doc, one), severity: "error" as const, message: one.message }));
    current.dispatch(setDiagnostics(current.state, found));
  }, [mistakes]);

  return <div ref={place} className={styles.code} />;
}

/** After "x." the ports of the unit, after "p." its parameters. */
function fieldsOf(at: CompletionContext, card: BlockCard | undefined) {
  const before = at.matchBefore(/\b[xp]\.\w*/);
  if (!before || !card) return null;
  const fields = before.text.startsWith("p.") ? card.parameters : [...card.inputs, ...card.outputs, ...card.taps];
  return {
    from: before.from + 2,
    validFor: /^\w*$/,
    options: fields.map(({ name, unit, meaning }) => ({ label: name, detail: unit, info: meaning })),
  };
}

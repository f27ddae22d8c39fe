import { TextInput } from "@mantine/core";
import { useState } from "react";
import { showError } from "../bench/send";

const LONGEST = 120;

interface NameFieldProps {
  label: string;
  /** The title shown without a name. */
  title: string;
  save(label: string): Promise<unknown>;
}

/** The name of a run or a campaign; Enter or leaving the field keeps it, Escape takes the old one back. */
export function NameField({ label, title, save }: NameFieldProps) {
  const [text, setText] = useState(label);
  const keep = () => {
    if (text.trim() !== label) save(text).catch(showError);
  };
  return (
    <TextInput
      label="Name"
      placeholder={title}
      maxLength={LONGEST}
      w={320}
      maw="100%"
      value={text}
      onChange={(e) => setText(e.currentTarget.value)}
      onBlur={keep}
      onKeyDown={(e) => {
        if (e.key === "Enter") e.currentTarget.blur();
        if (e.key === "Escape") setText(label);
      }}
    />
  );
}

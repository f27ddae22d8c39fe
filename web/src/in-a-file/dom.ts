type Child = Node | string;

/** A new element with properties and content. */
export function element<K extends keyof HTMLElementTagNameMap>(
  kind: K,
  properties: Partial<HTMLElementTagNameMap[K]> = {},
  ...content: Child[]
): HTMLElementTagNameMap[K] {
  const made = Object.assign(document.createElement(kind), properties);
  made.append(...content);
  return made;
}

/** A button with a word. */
export const button = (word: string, onclick: () => void, className = "") =>
  element("button", { type: "button", className: `button ${className}`, onclick }, word);

/** A menu of choices; the value of each and its word. */
export function menu(
  label: string,
  choices: readonly (readonly [string, string])[],
  chosen: string,
  choose: (value: string) => void,
): HTMLSelectElement {
  const made = element("select", { ariaLabel: label, title: label });
  for (const [value, word] of choices) made.append(element("option", { value }, word));
  made.value = chosen;
  made.onchange = () => choose(made.value);
  return made;
}

/** Write a text where it differs. */
export function write(node: HTMLElement, text: string): void {
  if (node.textContent !== text) node.textContent = text;
}

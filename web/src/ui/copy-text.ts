/** Copy a text; without TLS a browser has no clipboard for pages but on this machine, and copies what is selected. */
export async function copyText(text: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const { activeElement } = document;
    const field = document.createElement("textarea");
    field.value = text;
    (activeElement?.parentElement ?? document.body).append(field); // a dialog keeps the focus within it
    field.select();
    document.execCommand("copy");
    field.remove();
    if (activeElement instanceof HTMLElement) activeElement.focus();
  }
}

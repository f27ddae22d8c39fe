/** Copy a text; a page of another machine without TLS has no clipboard, so it copies a selected field. */
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

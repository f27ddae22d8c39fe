/** Flips between dark and light; the page puts the real thing in when it stands. */
export const themeSwitch = { flip: (): void => undefined };

import type { Scheme } from "../ui/palette";

/** Dress the page as the system of the reader is, now and when that changes. */
export function followScheme(dress: (scheme: Scheme) => void = () => undefined): void {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const follow = () => {
    const scheme = dark.matches ? "dark" : "light";
    document.documentElement.dataset.mantineColorScheme = scheme;
    dress(scheme);
  };
  dark.addEventListener("change", follow);
  follow();
}

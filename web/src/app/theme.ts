import {
  Checkbox,
  type CSSVariablesResolver,
  createTheme,
  type MantineColorsTuple,
  Radio,
  Switch,
} from "@mantine/core";

const accent: MantineColorsTuple = [
  "#eef3ff",
  "#dbe5ff",
  "#b6caff",
  "#8fb0ff",
  "#6a92f5",
  "#4b76e2",
  "#3a63d4",
  "#2c55c8",
  "#2648ab",
  "#1c3787",
];
const alarm: MantineColorsTuple = [
  "#fff0ef",
  "#ffdcd9",
  "#ffb6b0",
  "#ff8c83",
  "#ff6b60",
  "#ee4a3e",
  "#d9352a",
  "#c4261d",
  "#a62820",
  "#841a14",
];

/** Mantine's own dark greys, in our hue. */
const dark: MantineColorsTuple = [
  "#e8ecf1",
  "#c4ccd5",
  "#9aa6b4",
  "#6b7886",
  "#2a333d",
  "#27303a",
  "#1e252d",
  "#161b21",
  "#11161b",
  "#0d1115",
];

/** A size of Mantine, or the least size for a finger. */
const atLeastTarget = (name: string, size: string | number = "sm") => `max(var(--${name}-${size}), var(--target))`;

const SMALL = { defaultProps: { size: "xs" } };

/** The label is centred on its box, which is larger than the letters for a finger. */
const BESIDE = { body: { alignItems: "center" } };

/** Mantine on our tokens. */
export const theme = createTheme({
  fontFamily: "var(--font)",
  headings: { fontFamily: "var(--font)", fontWeight: "600" },
  primaryColor: "accent",
  primaryShade: { light: 7, dark: 3 },
  autoContrast: true,
  luminanceThreshold: 0.35,
  colors: { accent, alarm, dark },
  defaultRadius: "sm",
  cursorType: "pointer",
  respectReducedMotion: true,
  fontSizes: {
    xs: "var(--size-0)",
    sm: "var(--size-1)",
    md: "var(--size-2)",
    lg: "var(--size-3)",
    xl: "var(--size-4)",
  },
  spacing: { xs: "4px", sm: "8px", md: "12px", lg: "16px", xl: "24px" },
  radius: { xs: "3px", sm: "5px", md: "6px", lg: "8px", xl: "12px" },
  components: {
    // the usual sizes: a place that needs another one says so
    Button: { defaultProps: { size: "compact-sm", variant: "default" } },
    ActionIcon: { defaultProps: { variant: "subtle" } },
    Autocomplete: SMALL,
    NativeSelect: SMALL,
    Select: SMALL,
    TextInput: SMALL,
    Textarea: SMALL,
    NumberInput: SMALL,
    SegmentedControl: SMALL,
    Tooltip: {
      defaultProps: {
        openDelay: 400,
        withArrow: true,
        multiline: true,
        maw: 320,
        color: "var(--raised)",
        c: "var(--text)",
      },
    },
    Notification: {
      defaultProps: { withBorder: true, closeButtonProps: { "aria-label": "Dismiss" } },
      styles: {
        root: { background: "var(--raised)" },
        title: { fontWeight: 600 },
        description: { color: "var(--text)" },
      },
    },
    // no letters below the smallest size of the page
    InputWrapper: {
      vars: () => ({ label: {}, error: {}, description: { "--input-description-size": "var(--size-0)" } }),
    },
    Pill: { styles: { root: { fontSize: "var(--size-0)" } } },
    Radio: Radio.extend({ vars: (_, { size }) => ({ root: { "--radio-size": atLeastTarget("radio-size", size) } }) }),
    Checkbox: Checkbox.extend({
      ...SMALL,
      styles: BESIDE,
      vars: (_, { size }) => ({ root: { "--checkbox-size": atLeastTarget("checkbox-size", size) } }),
    }),
    Switch: Switch.extend({
      ...SMALL,
      styles: BESIDE,
      vars: (_, { size }) => ({ root: { "--switch-height": atLeastTarget("switch-height", size) } }),
    }),
    Slider: { defaultProps: { thumbSize: "var(--thumb)" } },
    Popover: { defaultProps: { shadow: "md", withinPortal: true } },
    // a menu longer than the window scrolls
    Menu: {
      // a menu holds nothing but items, so it opens with the first of them in focus
      defaultProps: {
        shadow: "md",
        withInitialFocusPlaceholder: false,
        middlewares: { flip: true, shift: true, size: { padding: 8 } },
      },
      styles: { dropdown: { overflowY: "auto" } },
    },
  },
});

export const cssVariables: CSSVariablesResolver = () => {
  const shared = {
    "--mantine-color-body": "var(--panel)",
    "--mantine-color-text": "var(--text)",
    "--mantine-color-dimmed": "var(--muted)",
    "--mantine-color-default": "var(--raised)",
    "--mantine-color-default-hover": "var(--hover)",
    "--mantine-color-default-color": "var(--text)",
    "--mantine-color-default-border": "var(--line)",
    "--mantine-color-placeholder": "var(--muted)",
    "--mantine-color-error": "var(--alarm)",
    // White reads on these in both schemes.
    "--mantine-color-accent-filled": "var(--accent-fill)",
    "--mantine-color-accent-filled-hover": "color-mix(in srgb, var(--accent-fill), #000 12%)",
    "--mantine-color-alarm-filled": "var(--alarm-fill)",
    "--mantine-color-alarm-filled-hover": "color-mix(in srgb, var(--alarm-fill), #000 12%)",
    "--mantine-color-accent-light": "var(--accent-soft)",
    "--mantine-color-accent-light-hover": "var(--accent-hover)",
    "--mantine-color-accent-light-color": "var(--accent)",
  };
  return { variables: {}, dark: shared, light: shared };
};

/** Flips between dark and light; the page sets the function. */
export const themeSwitch = { flip: (): void => undefined };

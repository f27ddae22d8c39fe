import { act, fireEvent, screen } from "@testing-library/react";
import { expect, it } from "vitest";
import { useView } from "../bench/view-store";
import { be, mount } from "../testing/render";
import { useRecords } from "./open-record";
import { RecordDrop } from "./record-drop";

const dropped = (name: string) => ({ dataTransfer: { types: ["Files"], files: [new File(["1,2"], name)] } });
const HINT = /^Drop a record of your device/;

it("takes a record that is dropped anywhere on the page", () => {
  useView.setState({ dialog: "none" });
  mount(<RecordDrop />);
  fireEvent.dragOver(document.body, dropped("mine.csv"));
  expect(screen.getByText(HINT)).toBeVisible();
  fireEvent.drop(document.body, dropped("mine.csv"));
  expect(screen.queryByText(HINT)).not.toBeInTheDocument();
  expect(useRecords.getState().file?.name).toBe("mine.csv");
  expect(useView.getState().dialog).toBe("record");
});

it("leaves other files, and places with drops of their own, alone", () => {
  useView.setState({ dialog: "none" });
  mount(
    // biome-ignore lint/a11y/noStaticElementInteractions: a place that takes drops in the page
    <div data-testid="own" onDrop={(event) => event.preventDefault()}>
      <RecordDrop />
    </div>,
  );
  fireEvent.drop(document.body, dropped("picture.png"));
  fireEvent.drop(screen.getByTestId("own"), dropped("mine.csv"));
  expect(useView.getState().dialog).toBe("none");
});

it("takes nothing from a watcher", () => {
  useView.setState({ dialog: "none" });
  mount(<RecordDrop />);
  act(() => be("watcher"));
  fireEvent.drop(document.body, dropped("mine.csv"));
  expect(useView.getState().dialog).toBe("none");
});

import { screen } from "@testing-library/react";
import { expect, it } from "vitest";
import { setPage, useView } from "../../bench/view-store";
import { connect } from "../../testing/fake-transport";
import { recordedBench } from "../../testing/recorded";
import { mount } from "../../testing/render";
import { PageHeader } from "./header";

const { bench } = await recordedBench("first-look");

it("names the bench with its state, leads back to it, and drives nothing", async () => {
  connect(bench);
  setPage("gallery");
  const { user } = mount(<PageHeader />);
  expect(screen.getByText(bench.title)).toBeVisible();
  expect(screen.getByTestId("bench-state")).toHaveTextContent("paused");
  expect(screen.queryByRole("timer")).not.toBeInTheDocument();
  const [back, ...others] = screen.getAllByRole("button");
  expect(others).toEqual([]);
  await user.click(back);
  expect(useView.getState().page).toBe("bench");
});

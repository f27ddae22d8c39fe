import { screen, waitFor } from "@testing-library/react";
import { beforeEach, expect, it, vi } from "vitest";
import { mount } from "../testing/render";
import { pngOf, saveFile } from "../ui/save-file";
import type { Picture } from "./picture";
import { PictureMenu } from "./picture-menu";

vi.mock("../ui/save-file", () => ({ saveFile: vi.fn(), pngOf: vi.fn() }));

const picture: Picture = {
  title: "A & B",
  stem: "a-and-b",
  height: 300,
  legend: [{ name: "one <first>", colour: "#123456" }],
  paint: (pen) => pen.fillText("time, ms", 10, 10),
};
const textOf = (file: Blob) =>
  new Promise<string>((done) => {
    const reader = new FileReader();
    reader.onload = () => done(String(reader.result));
    reader.readAsText(file);
  });

beforeEach(() => vi.mocked(saveFile).mockReset());

async function keep(kind: "PNG" | "SVG", take: () => Picture | undefined, name?: string) {
  const { user } = mount(<PictureMenu take={take} name={name} />);
  await user.click(screen.getByRole("button", { name: name ? `Export: ${name}` : "Export" }));
  await user.click(await screen.findByText(kind));
}

it("saves the picture as SVG, with title, legend and axes, under its own name", async () => {
  await keep("SVG", () => picture);
  await waitFor(() => expect(saveFile).toHaveBeenCalledTimes(1));
  const [name, content] = vi.mocked(saveFile).mock.calls[0];
  expect(name).toBe("a-and-b.svg");
  const svg = new DOMParser().parseFromString(await textOf(content), "image/svg+xml");
  expect(svg.querySelector("parsererror")).toBeNull();
  const texts = [...svg.querySelectorAll("text")].map(({ textContent }) => textContent);
  expect(texts).toEqual(expect.arrayContaining(["A & B", "one <first>", "time, ms"]));
});

it("saves the same picture as PNG", async () => {
  const png = new Blob(["png"], { type: "image/png" });
  vi.mocked(pngOf).mockResolvedValue(png);
  await keep("PNG", () => picture, "first");
  await waitFor(() => expect(saveFile).toHaveBeenCalledWith("a-and-b.png", png));
  expect(vi.mocked(pngOf).mock.calls[0][0]).toContain("time, ms");
});

it("saves nothing before anything is shown", async () => {
  await keep("SVG", () => undefined);
  expect(saveFile).not.toHaveBeenCalled();
});

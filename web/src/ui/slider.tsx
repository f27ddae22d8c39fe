import { Slider as MantineSlider, type SliderProps } from "@mantine/core";
import { useRef } from "react";

/** A slider that ends after its last move: Mantine's says a move at the next picture, and the end of a quick one before. */
export function Slider({ onChange, onChangeEnd, ...others }: SliderProps) {
  const last = useRef<number | undefined>(undefined);
  return (
    <MantineSlider
      {...others}
      onChange={(value) => {
        last.current = value;
        onChange?.(value);
      }}
      onChangeEnd={(value) => {
        requestAnimationFrame(() => {
          onChangeEnd?.(last.current ?? value);
          last.current = undefined;
        });
      }}
    />
  );
}

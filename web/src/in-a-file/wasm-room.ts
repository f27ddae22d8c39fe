const PAGE = 1 << 16;
const ALIGNMENT = 64;
const STACK_BYTES = 1 << 20;

type Numbers = Float64Array | Float32Array | BigInt64Array | BigUint64Array | Uint8Array;

/** An array in the memory of the code: how the page sees it, and how the code takes it. */
export interface Placed<T extends Numbers = Numbers> {
  view: T;
  at: number;
  lengths: number[];
}

interface NumbersKind<T> {
  readonly BYTES_PER_ELEMENT: number;
  new (buffer: ArrayBuffer, at: number, count: number): T;
}

/** The memory of WebAssembly with arrays in it, and the functions of its code. */
export class WasmRoom {
  private readonly exports: Record<string, (...numbers: number[]) => number>;
  private readonly buffer: ArrayBuffer;
  private readonly results: Placed<Float64Array>;
  private next: number;

  private constructor(instance: WebAssembly.Instance, memory: WebAssembly.Memory) {
    this.exports = instance.exports as Record<string, (...numbers: number[]) => number>;
    this.buffer = memory.buffer as ArrayBuffer;
    this.next = this.exports.room();
    this.results = this.place(Float64Array, [4]);
  }

  /** Load code with room for so many bytes of arrays. */
  static async load(code: BufferSource | WebAssembly.Module, bytes: number): Promise<WasmRoom> {
    const module = code instanceof WebAssembly.Module ? code : await WebAssembly.compile(code);
    const pages = Math.ceil((bytes + STACK_BYTES) / PAGE) + 2;
    const memory = new WebAssembly.Memory({ initial: pages, maximum: pages });
    const stack = new WebAssembly.Global({ value: "i32", mutable: true }, pages * PAGE);
    const env = { __linear_memory: memory, __stack_pointer: stack, fmod: (a: number, b: number) => a % b };
    return new WasmRoom(await WebAssembly.instantiate(module, { env }), memory);
  }

  /** A new array of these lengths, all of it zero. */
  place<T extends Numbers>(kind: NumbersKind<T>, lengths: number[]): Placed<T> {
    const count = lengths.reduce((product, one) => product * one, 1);
    const at = Math.ceil(this.next / ALIGNMENT) * ALIGNMENT;
    this.next = at + Math.max(1, count) * kind.BYTES_PER_ELEMENT;
    return { view: new kind(this.buffer, at, count), at, lengths };
  }

  /** A new array with these numbers. */
  put<T extends Numbers>(numbers: T, lengths = [numbers.length]): Placed<T> {
    const placed = this.place(numbers.constructor as unknown as NumbersKind<T>, lengths);
    placed.view.set(numbers as never);
    return placed;
  }

  /** Call a function of the code; the array holds its results until the next call. */
  call(name: string, ...given: (number | Placed)[]): Float64Array {
    const taken = given.flatMap((one) => (typeof one === "number" ? one : [one.at, ...one.lengths]));
    this.exports[name](this.results.at, ...taken);
    return this.results.view;
  }
}

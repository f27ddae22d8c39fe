"""WebAssembly of kernels and steps: the instructions of machine code, for a browser or behind a wall."""

"""WebAssembly of kernels and steps: the instructions that machine code is made of, for a machine in a browser or a wall."""

"""A live bench in one file: WebAssembly of its blocks and its loop, its numbers, and all that a command writes."""

"""The second wall around units of one's own: their steps as WebAssembly, in memory of their own."""

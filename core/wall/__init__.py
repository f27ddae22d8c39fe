"""The second wall around user units: their steps as WebAssembly, each in its own memory."""

"""User units: text in the notation of the library, checked node by node and never executed as Python."""

"""Read-outs: what they conclude from the rate a controller estimates."""

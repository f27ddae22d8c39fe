"""Read-outs: conclusions from the rate that a controller estimates."""

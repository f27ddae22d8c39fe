"""The benchmark of fault diagnosis ``mems-diag-1``: tracks, seeds, figures, and the results of diagnosers."""

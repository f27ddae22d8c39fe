"""The data that outlives the process: the run table, the recordings, their files."""

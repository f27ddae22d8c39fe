"""What outlives the process: the run table, the recordings, their files."""

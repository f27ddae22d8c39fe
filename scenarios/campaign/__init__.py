"""Campaigns: one scenario at many points with many seeds, the processes that compute it, and the sums of its runs."""

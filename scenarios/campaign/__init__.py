"""Campaigns: one scenario at many points with many seeds, where the runs are computed, and what they add up to."""

"""What people are given of a run or a campaign: traces, reports, drawings, scripts."""

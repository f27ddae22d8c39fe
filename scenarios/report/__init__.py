"""Files of a run or a campaign for people: traces, reports, drawings, scripts."""

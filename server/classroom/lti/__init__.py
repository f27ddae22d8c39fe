"""Launches by LTI 1.3 from a learning platform, and scores sent back; loaded only where a platform is configured."""

"""Computations of requests, in processes of their own with limits."""

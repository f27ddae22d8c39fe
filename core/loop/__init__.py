"""Blocks that every bench has: environment, effects, measurement, model, drive, guard, and the score of a diagnoser."""

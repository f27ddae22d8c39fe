"""Boards side by side: the same steps compiled for many boards at a time, with the same bits for each.

A step is a Python function of few kinds of statements, so the project translates it itself. A number of a board
becomes a vector register with that number of all boards; where boards differ in a condition, both branches run and
each board keeps its own result. What all boards share (the tick, and fields declared as ``Choice``) stays a plain
number, and a branch on it a real branch.
"""

"""From a step to machine code: one translator for one board and for boards side by side, with the same bits for each.

A step is a Python function of few kinds of statements, so the project translates it itself. For one board each number
is a number. For boards side by side it becomes a vector register with that number of all boards; where boards differ in
a condition, both branches run and each board keeps its own result. What all boards share (the tick, and fields declared
as ``Choice``) stays a plain number, and a branch on it a real branch.
"""

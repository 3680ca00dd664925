"""Test cases: what a job of continuous integration shows of plans, many parts and comparisons.

May use: the plan file and its words; no arrays, no document, no kernel. `case` is a test case, `plan` makes those of one plan; a
comparison and a batch make theirs in their own rooms. `junit` and `sarif` are the forms of a file, `files` writes them.
"""

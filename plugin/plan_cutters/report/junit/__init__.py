"""JUnit XML: what a job of continuous integration shows of plans, many parts and comparisons.

May use: the plan file and its words; no arrays, no document, no kernel. `cases` is the form of the file, `plan` makes the cases
of one plan; a comparison and a batch make theirs in their own rooms.
"""

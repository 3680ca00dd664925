"""Laws at random, for long: `python -m tests.soak --minutes 30`.

Random parts, tools, machines, setups, fixtures and options; verdicts against the exact surface, laws of plans, whole commands and
the checker. What falls is made smaller and printed as a test. Every case has a seed that makes it again alone:
`python -m tests.soak --only LAW --case SEED`.

`solids` has bodies in closed form, `cases` draws, `truth` says how deep a surface lies in a tool, `exact`, `laws`, `files` and
`commands` are the laws, and `run` draws, watches, shrinks and tells.
"""

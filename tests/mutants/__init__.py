"""How many small faults in the program do the tests of a room notice? `python -m tests.mutants --help`."""

"""A public benchmark of cutter accessibility: parts with known answers, a neutral format, a scorer.

It imports nothing of any program that it scores; only the modules of `programs` call one.
"""

VERSION = "1.0"

"""This module defines what is said of kept work that cannot be used."""


class CacheWarning(UserWarning):
    """Machine code in the compiler's cache is damaged, or cannot be read or written: compiling it anew takes time alone."""

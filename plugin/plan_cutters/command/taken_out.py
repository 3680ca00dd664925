"""Words of the command line that are gone, and what to use instead."""

#: Options by their word, commands as "command WORD", values as "--option VALUE": what to use instead.
TAKEN_OUT: dict[str, str] = {}


def instead(word: str) -> str:
    """Say what to use in place of a word that is gone, as an error; "" for a word that never was.

    >>> instead("--never-was")
    ''
    """
    use = TAKEN_OUT.get(word)
    return f"{word} was taken out: {use}" if use else ""

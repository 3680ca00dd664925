"""Words of the command line that are gone, and what to use instead."""

#: Options by their word, commands as "command WORD", values as "--option VALUE": what to use instead.
TAKEN_OUT: dict[str, str] = {
    "--answers mend-all": "give --answers mend, for the three nearest cutters, and plan with another one alone to ask for it"
}


def instead(word: str) -> str:
    """Say what a word that is gone has in its place, as the end of an error; "" for a word that never was.

    >>> instead("--never-was")
    ''
    """
    use = TAKEN_OUT.get(word)
    return f"{word} was taken out: {use}" if use else ""

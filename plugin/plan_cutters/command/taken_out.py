"""Words of the command line that are gone, and what to use instead."""

#: Options by their word, commands as "command WORD", values as "--option VALUE": what to use instead.
TAKEN_OUT: dict[str, str] = {
    "--cluster": "one part is judged here; `plan-cutters batch PART... --out DIR --cluster ADDRESS` plans whole parts on others",
    "--verdicts": "leave it out: verdicts are stored in the user's cache folder, with all else of a part (PLAN_CUTTERS_CACHE)",
    "--verdicts-key": "leave it out: what is stored in a folder that others may write to is not read",
}


def instead(word: str) -> str:
    """What a word that is gone has in its place, as the end of an error; "" for a word that never was.

    >>> instead("--never-was")
    ''
    """
    use = TAKEN_OUT.get(word)
    return f"{word} was taken out: {use}" if use else ""

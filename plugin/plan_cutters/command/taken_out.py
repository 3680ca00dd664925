"""Words of the command line that are gone, and what to use instead."""

#: Options by their word, commands as "command WORD", values as "--option VALUE": what to use instead.
TAKEN_OUT: dict[str, str] = {
    "command stored": "plan again with the other machine or setup; the kept stages answer",
    "--postures": "plan again with the other machine or setup; the kept stages answer",
    "--formats regions": "the regions and axes of --operations stand in plan.json",
    "--formats plans": "leave it out; STEP and GLB of both plans are written with --operations both",
    "--answers stick-out-map": "give --answers stick-out; in Python, on_face asks for that of one face",
}


def instead(word: str) -> str:
    """What a word that is gone has in its place, as the end of an error; "" for a word that never was.

    >>> instead("--never-was")
    ''
    """
    use = TAKEN_OUT.get(word)
    return f"{word} was taken out: {use}" if use else ""

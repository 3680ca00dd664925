"""Words of the command line that are gone, and what to use instead."""

#: Options by their word, commands as "command WORD", values as "--option VALUE": what to use instead.
TAKEN_OUT: dict[str, str] = {
    "command stored": "plan again with the other machine or setup; stored stages make that short",
    "--postures": "plan again with the other machine or setup; stored stages make that short",
    "--formats regions": "the regions and axes of --operations stand in plan.json",
    "--formats plans": "leave it out; STEP and GLB of both plans are written with --operations both",
    "--answers stick-out-map": "give --answers stick-out; in Python, result.face(F1, stick_out=True) is about a face",
    "--answers mend-all": "give --answers mend, for the three nearest cutters, and plan with another one alone to ask for it",
    "--cluster": "one part is judged here; `plan-cutters batch PART... --out DIR --cluster ADDRESS` plans whole parts on others",
    "--verdicts": "leave it out: verdicts are stored in the user's cache folder, with all else of a part (PLAN_CUTTERS_CACHE)",
    "--verdicts-key": "leave it out: what is stored in a folder that others may write to is not read",
}


def instead(word: str) -> str:
    """Say what to use in place of a word that is gone, as an error; "" for a word that never was.

    >>> instead("--never-was")
    ''
    """
    use = TAKEN_OUT.get(word)
    return f"{word} was taken out: {use}" if use else ""

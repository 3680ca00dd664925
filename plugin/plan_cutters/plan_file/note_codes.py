"""Notes of a plan: each has a code, by which programs decide, and a text for people."""

from typing import Literal, NamedTuple

#: What a note is about. A text may be reworded; a code stays.
NoteCode = Literal[
    "cutters_built_in", "no_holder", "tilts_not_searched", "all_length_cuts", "samples_apart", "samples_coarser", "samples_wide",
    "not_sampled", "no_machine", "side_guessed", "side_by_setup", "tolerance_raised", "open_faces", "fixture", "fixture_stays",
    "fixture_not_cad", "faces_none_sculptured", "faces_ignored", "faces_clamped", "travel_not_judged", "travel_of_holder",
    "travel_first_setup", "faces_clamped_there", "setup_without_fixtures", "setup_proposed",
    "faces_loose", "area_not_looked_at", "area_proved", "area_left", "area_unknown", "maps_partial",
]  # fmt: skip


class Note(NamedTuple):
    """A note tells a reader of the plan something that the verdicts do not say."""

    code: NoteCode
    text: str

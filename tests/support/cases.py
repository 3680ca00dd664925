"""Test cases of any text: names of files and faces hold anything that a file system or a CAD file holds."""

from hypothesis import strategies as st

TEXT = st.text(st.characters(codec=None), max_size=20)
OUTCOMES = ["passed", "skipped", "failure", "error"]

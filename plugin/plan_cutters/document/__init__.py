"""The plan file: its form, how results become it, and its colours. May use: scene and domain."""

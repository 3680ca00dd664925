"""Tool libraries: what other programs and people write about tools, read into cutters."""

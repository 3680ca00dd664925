"""One result, many writers: each format is a module with one function, and the output folder knows them all.

May use: the document and `cad_io`; no stage.
"""

from plan_cutters.report.folder import DEFAULT_FORMATS, FORMATS, PLAN, Staging, file_name, read_formats, stale_files, write_all

__all__ = ["DEFAULT_FORMATS", "FORMATS", "PLAN", "Staging", "file_name", "read_formats", "stale_files", "write_all"]

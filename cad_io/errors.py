"""This module defines the errors of `cad_io`. Every error names the file, the face where there is one, and the cause."""


class CadIoError(Exception):
    """Base of all errors of `cad_io`: the fault and its remedy in one line, the file and the face (as `F12`) concerned."""

    def __init__(self, cause: str, *, file: str | None = None, face: str | None = None) -> None:
        self.cause, self.file, self.face = cause, file, face
        super().__init__(": ".join(p for p in (file, face, cause) if p))


class ReadError(CadIoError):
    """The part cannot be read, or holds no surface to judge."""


class WriteError(CadIoError):
    """A file cannot be written."""


class SampleError(CadIoError):
    """A surface cannot be sampled or located as asked."""

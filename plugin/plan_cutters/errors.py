"""Planning raises these errors. Every error says the file, the face where there is one, and the cause."""


def extra_hint(extra: str) -> str:
    """Name the command that installs an extra. It takes the project's folder: no package index has the program.

    >>> extra_hint("batch")
    'pip install ".[batch]" in the folder of plan-cutters'
    """
    return f'pip install ".[{extra}]" in the folder of plan-cutters'


class PlanError(Exception):
    """Base of all errors of `plan_cutters`.

    Parameters
    ----------
    cause : str
        What is wrong and what to try, one line.
    file, face : str, optional
        The file and face concerned.
    """

    def __init__(self, cause: str, *, file: str | None = None, face: str | None = None) -> None:
        self.cause, self.file, self.face = cause, file, face
        super().__init__(": ".join(p for p in (file, face, cause) if p))


class OptionError(PlanError):
    """An option has no meaning."""


class TooManySamplesError(OptionError):
    """The requested density asks for more samples than a plan may take."""


class CutterError(OptionError):
    """A cutter or a holder cannot exist."""


class HolderFitError(CutterError):
    """A cutter does not fit the holder that is to hold it."""


class MachineError(OptionError):
    """A machine is unknown or contradicts itself."""


class FixtureError(OptionError):
    """A fixture cannot exist, or cannot stand where it is asked to."""


class LibraryError(PlanError):
    """A tool library cannot be read, or holds no tool that can be used."""


class UnjudgeableError(PlanError):
    """The part was read, but holds nothing that could be judged."""

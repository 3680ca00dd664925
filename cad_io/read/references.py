"""Files that a STEP file refers to: parts of an assembly that lie in files of their own.

They are found in the text, without the CAD kernel, so that whoever keeps or sends a part knows what belongs to it.
"""

import os
import re
from collections.abc import Callable, Iterator

from cad_io import files
from cad_io.errors import ReadError

#: The entities that name one, each by its first text (ISO 10303-21; AP214 and AP242 call them external documents).
_WORDS = b"APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT", b"DOCUMENT_FILE"
_NAMED = re.compile(rb"(?:" + b"|".join(_WORDS) + rb")\s*\(\s*'((?:[^']|'')*)'")
#: Documents beside the shape: that one is not there costs no geometry.
DOCUMENTS = (".pdf", ".txt", ".doc", ".docx", ".xls", ".xlsx", ".csv", ".htm", ".html", ".jpg", ".jpeg", ".png", ".tif",
              ".tiff", ".svg")  # fmt: skip
#: Files that are followed from one, at most.
_MOST = 10_000


def names(data: bytes) -> tuple[str, ...]:
    """Names of the files that a STEP file's text refers to, as they stand there, each once."""
    if not any(word in data for word in _WORDS):
        return ()
    # As the kernel takes them: a folder of Windows is one on every system.
    found = dict.fromkeys(os.fsdecode(each.replace(b"''", b"'").replace(b"\\", b"/")) for each in _NAMED.findall(data))
    return tuple(name for name in found if name.strip())


def followed(data: bytes, read: Callable[[str], bytes | None]) -> Iterator[tuple[str, bytes | None]]:
    """Follow the references of a STEP file, and those of the files that they lead to.

    Parameters
    ----------
    data : bytes
        Content of the file; one that is no STEP file refers to nothing.
    read : callable
        Content of a file by its path from the folder of the first one; None where there is none.

    Yields
    ------
    (str, bytes or None)
        That path, and the content; each path once.

    Raises
    ------
    ReadError
        There are too many.
    """
    seen: set[str] = set()
    waiting = [("", data)]
    while waiting:
        folder, content = waiting.pop()
        for name in names(content):
            path = os.path.normpath(os.path.join(folder, name))
            if path in seen:
                continue
            if len(seen) >= _MOST:
                raise ReadError(f"refers to more than {_MOST} files: save the assembly as one file")
            seen.add(path)
            found = read(path)
            yield path, found
            if found is not None:
                waiting.append((os.path.dirname(path), found))


def fingerprint_of(data: bytes, read: Callable[[str], bytes | None]) -> str:
    """Checksum of a CAD file with all that it refers to (`cad_io.files.fingerprint`); parameters as of `followed`."""
    return files.fingerprint(files.checksum(data), files.checksums(followed(data, read)))


def beside(file: str | os.PathLike[str]) -> Callable[[str], bytes | None]:
    """Read files by their paths from the folder of a file; None where there is none that can be read.

    Raises
    ------
    cad_io.files.OutsideError
        One may not be read.
    """
    folder = os.path.dirname(os.fspath(file))

    def read(name: str) -> bytes | None:
        try:
            return files.content(os.path.join(folder, name))
        except files.OutsideError:
            raise
        except (OSError, ValueError):
            return None

    return read

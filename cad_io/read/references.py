"""Files that a STEP file refers to: parts of an assembly that lie in files of their own.

They are found in the text, without the CAD kernel, so that whoever keeps or sends a part knows what belongs to it.
"""

import os
import re
from collections.abc import Callable, Iterator

from cad_io.errors import ReadError
from plan_cutters_base import user_files as files

#: The entities that name a file, each by its first text, and their short names (ISO 10303-21; AP214 and AP242 call them
#: external documents).
WORDS = b"APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT", b"DOCUMENT_FILE", b"APEXIA", b"DCMFL"
_NAMED = re.compile(rb"(?:" + b"|".join(WORDS) + rb")\s*\(\s*'((?:[^']|'')*)'")
#: A comment, or a text, in which none begins.
_COMMENT = re.compile(rb"/\*.*?\*/|'[^']*'", re.DOTALL)
#: Letters beyond ASCII, and a backslash, as a text has them (ISO 10303-21, 6.4.3).
_LETTERS = re.compile(rb"\\X2\\((?:[0-9A-Fa-f]{4})*)\\X0\\|\\X4\\((?:[0-9A-Fa-f]{8})*)\\X0\\|\\X\\([0-9A-Fa-f]{2})|\\S\\(.)|\\\\")
#: Documents beside the shape: that one is not there costs no geometry.
DOCUMENTS = (".pdf", ".txt", ".doc", ".docx", ".xls", ".xlsx", ".csv", ".htm", ".html", ".jpg", ".jpeg", ".png", ".tif",
              ".tiff", ".svg")  # fmt: skip
#: Files that are followed from one, at most.
_MOST = 10_000


def names(data: bytes) -> tuple[str, ...]:
    """Names of the files that a STEP file's text refers to, as the CAD kernel reads them there, each once."""
    if not any(word in data for word in WORDS):
        return ()
    if b"/*" in data:
        data = _COMMENT.sub(lambda match: b" " if match[0].startswith(b"/") else match[0], data)
    return tuple(name for name in dict.fromkeys(map(_name, _NAMED.findall(data))) if name.strip())


def _name(text: bytes) -> str:
    """The name of a file that a text in STEP stands for: a long one may be broken into lines."""
    whole = text.replace(b"\r", b"").replace(b"\n", b"").replace(b"''", b"'")
    # As the kernel takes them: a folder of Windows is one on every system.
    return os.fsdecode(_LETTERS.sub(_letters, whole)).replace("\\", "/")


def _letters(match: re.Match[bytes]) -> bytes:
    two, four, one, upper = match.groups()
    if two is not None:
        text = bytes.fromhex(two.decode()).decode("utf-16-be", "replace")
    elif four is not None:
        text = bytes.fromhex(four.decode()).decode("utf-32-be", "replace")
    elif one is not None:
        text = bytes.fromhex(one.decode()).decode("latin-1")
    else:
        text = "\\" if upper is None else chr(upper[0] | 0x80)
    return text.encode()


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
            raw = read(path)
            yield path, raw
            if raw is not None:
                waiting.append((os.path.dirname(path), raw))


def in_folder_of(file: str | os.PathLike[str]) -> Callable[[str], bytes | None]:
    """Read files by their paths from the folder of a file; None where there is none that can be read.

    Raises
    ------
    plan_cutters_base.user_files.OutsideError
        One may not be read.
    ReadError
        One is a pipe or a device, which the kernel would wait for.
    """
    folder = os.path.dirname(os.fspath(file))

    def read(name: str) -> bytes | None:
        try:
            return files.content(os.path.join(folder, name))
        except files.OutsideError:
            raise
        except files.IrregularError as error:
            if os.path.isdir(os.path.join(folder, name)):
                return None
            raise ReadError(f"refers to {name}, which {error}: save the part that it was in its place") from None
        except (OSError, ValueError):
            return None

    return read

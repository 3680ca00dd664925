"""Seals: checksums that tell damage, and with a key also what nobody who has the key wrote."""

import hashlib
import hmac
import json
from collections.abc import Mapping
from typing import Any

from cad_io import files
from plan_cutters.errors import OptionError

#: Bytes of a key.
_LEAST, _MOST = 16, 4096


def key_of(file: str) -> bytes:
    """Read a key: all bytes of a file, without white space at its end.

    Raises
    ------
    OptionError
        It cannot be read, or is too short to keep anybody out.
    """
    try:
        key = files.content(file, _MOST + 1).rstrip()
    except (OSError, ValueError) as fault:
        raise OptionError(f"cannot be read: {getattr(fault, 'strerror', None) or fault}", file=file) from None
    if not _LEAST <= len(key) <= _MOST:
        raise OptionError(
            f"is no key: {len(key)} bytes; a key has {_LEAST} to {_MOST}, as `head -c 32 /dev/urandom | base64` makes them",
            file=file,
        )
    return key


def stamp(data: bytes, key: bytes | None) -> str:
    """SHA-256 of data, by hexadecimal digits; with a key its HMAC (RFC 2104)."""
    return (hashlib.sha256(data) if key is None else hmac.new(key, data, hashlib.sha256)).hexdigest()


def seal(record: Mapping[str, Any], key: bytes | None) -> str:
    """Stamp a record of JSON, all but its own entry `seal`."""
    text = json.dumps({name: value for name, value in record.items() if name != "seal"}, sort_keys=True)
    return stamp(text.encode(), key)

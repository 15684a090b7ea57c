"""The statuses that a call of the library can return: the numbers of `ricci_status` in `ricci.h`."""

from __future__ import annotations

from enum import IntEnum

from ricci._library import ffi, lib

__all__ = ["Status"]


class Status(IntEnum):
    """The statuses of the library. A number is never given out again.

    Examples
    --------
    >>> ricci.Status.OK.text
    'done'
    """

    OK = 0
    WRONG_SIZE = 1
    ARGUMENT = 2
    TOO_LARGE = 3
    CANCELLED = 4
    NULL_POINTER = 10
    PANIC = 11
    POISONED = 12
    BUFFER_TOO_SMALL = 13
    STRUCT_SIZE = 14
    NO_MEMORY = 15
    LEFT_OUT = 16
    IO = 100
    PARSE = 101
    UNKNOWN_FORMAT = 102
    DEFECTS = 200
    GLUING = 201
    CONNECTIVITY = 202
    EDGE_LENGTH = 300
    TRIANGLE_INEQUALITY = 301
    EDGE_WEIGHT = 302
    DOMAIN = 303
    TARGET_AT_VERTEX = 400
    TARGET_TOTAL = 401
    TARGET_KIND = 402
    TARGET_BELOW = 403
    FACTORISATION = 500
    LAYOUT = 600
    MATCHING = 650
    SPLINE = 700

    @property
    def text(self) -> str:
        """One sentence on the status."""
        return str(ffi.string(lib.ricci_status_text(self)).decode())

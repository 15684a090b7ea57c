"""The library's log messages, as records of Python's `logging` under the name ``ricci``."""

from __future__ import annotations

import atexit
import logging
from typing import Any, Literal

from ricci._call import constant
from ricci._library import ffi, lib
from ricci.control import check

__all__ = ["log_to_logging"]

Level = Literal["off", "error", "warn", "info", "debug", "trace"]
# Levels of `logging` for RICCI_LOG_ERROR to RICCI_LOG_TRACE.
_LEVELS = {1: logging.ERROR, 2: logging.WARNING, 3: logging.INFO, 4: logging.DEBUG, 5: logging.DEBUG}


@ffi.callback("void(uint32_t, const char *, void *)")  # type: ignore[untyped-decorator]
def _receive(level: int, message: Any, _: Any) -> None:
    logging.getLogger("ricci").log(_LEVELS.get(level, logging.DEBUG), "%s", ffi.string(message).decode("utf-8", "replace"))


def log_to_logging(level: Level = "info") -> None:
    """Send messages up to this level to the logger ``ricci``; ``"off"`` stops that. For the whole process.

    Parameters
    ----------
    level : Level
        the least important level that is passed on.

    Examples
    --------
    >>> ricci.log_to_logging("warn")
    """
    check(lib.ricci_log_set(ffi.NULL if level == "off" else _receive, ffi.NULL, constant("LOG", level)))


# A message that came while the interpreter ends would find no interpreter.
atexit.register(log_to_logging, "off")

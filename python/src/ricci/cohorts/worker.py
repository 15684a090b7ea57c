"""The process of a worker of a cohort: it does the work on the meshes that its parent names, and ends when the parent does."""

from __future__ import annotations

import os
import pickle
import queue
import signal
import threading
from multiprocessing.connection import Connection
from typing import Any

__all__ = ["LOADED", "REFUSED", "ROW", "serve"]

# The kinds of messages to the parent: the work could be loaded, or not (with a text), and the row of a mesh.
LOADED, REFUSED, ROW = "loaded", "refused", "row"


def _send(connection: Connection, kind: str, content: Any) -> None:
    connection.send_bytes(pickle.dumps((kind, content)))


def _listen(connection: Connection, paths: queue.SimpleQueue[str]) -> None:
    """Takes the paths that the parent sends. If the parent is gone, the process ends at once, whatever it is at."""
    try:
        while True:
            paths.put(connection.recv_bytes().decode("utf-8", "surrogateescape"))
    except (EOFError, OSError):
        os._exit(0)


def serve(descriptor: int) -> None:
    """Take the work, then one path after the other, and answer with rows. Ctrl-C is the parent's to take: it ends its workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    connection = Connection(descriptor)
    try:
        work = pickle.loads(connection.recv_bytes())
    except EOFError:
        return
    except BaseException as wrong:
        _send(connection, REFUSED, f"{type(wrong).__name__}: {wrong}")
        return
    _send(connection, LOADED, None)
    paths: queue.SimpleQueue[str] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(connection, paths), daemon=True).start()
    while True:
        _send(connection, ROW, work(paths.get()))

"""Objects that are kept as bytes and files, and read back bit for bit: by pickle, by caches, by `save` and `load`."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any, Self

from ricci._call import _KINDS, Handle, Passed, call, path_bytes, summary
from ricci._library import ffi, lib
from ricci._structs import Struct
from ricci.control import Progress
from ricci.errors import ArgumentError, ArgumentTypeError
from ricci.figures import ArchiveSummary

__all__ = ["Archive", "Kept", "load"]


class Archive(Passed):
    """The bytes of one object. They never change."""

    def __init__(self, function: Callable[..., int], *arguments: Any, progress: Progress = None) -> None:
        out = ffi.new("ricci_archive **")
        call(function, *arguments, out, progress=progress)
        self._pointer = ffi.gc(out[0], lib.ricci_archive_free)

    @classmethod
    def of(cls, field: str, address: Any, mirrored: bool = False, progress: Progress = None) -> Self:
        """The archive of the object at this address, which belongs into this field."""
        struct = Struct("objects")
        setattr(struct._pointer, field, address)
        struct._kept.append(address)
        struct.put("mirrored", int(mirrored))
        return cls(lib.ricci_archive_new, struct, progress=progress)

    @classmethod
    def parse(cls, data: bytes | bytearray | memoryview) -> Self:
        """The archive with these bytes."""
        try:
            given = ffi.from_buffer("uint8_t[]", data)
        except (TypeError, ValueError, BufferError) as wrong:
            raise ArgumentTypeError(f"bytes are needed, not {type(data).__name__}") from wrong
        return cls(lib.ricci_archive_parse, given, len(given))

    @classmethod
    def read(cls, path: str | os.PathLike[str], progress: Progress = None) -> Self:
        """The archive of a file."""
        return cls(lib.ricci_archive_read, path_bytes(path), progress=progress)

    def write(self, path: str | os.PathLike[str], progress: Progress = None) -> None:
        """Write the archive as a file."""
        call(lib.ricci_archive_write, self, path_bytes(path), progress=progress)

    @cached_property
    def summary(self) -> ArchiveSummary:
        """Kind and size."""
        return summary(ArchiveSummary, "archive", self)

    def bytes(self) -> bytes:
        """A copy of the bytes."""
        out = ffi.new("uint8_t[]", self.summary.n_bytes)
        call(lib.ricci_archive_bytes, self, out, self.summary.n_bytes)
        return bytes(ffi.buffer(out))

    def object(self, progress: Progress = None) -> Any:
        """The object in it, an instance of the class that its type has."""
        out = Struct("objects")
        call(lib.ricci_archive_objects, self, out, ffi.sizeof("ricci_objects"), progress=progress)
        found: dict[str, Any] = {}
        for name, field in ffi.typeof("ricci_objects").fields:
            address = getattr(out._pointer, name)
            if field.type.kind == "pointer" and address != ffi.NULL:
                kind = _KINDS[field.type.item.cname]
                found[name] = kind.__new__(kind)
                Handle.__init__(found[name], address)
        # A mesh comes with those that were made from it, and a layout with its charts.
        field = next((name for name in found if name not in _ORIGINS), "layout" if "layout" in found else "mesh")
        made = found.pop(field)
        made._come_from({**found, "mirrored": bool(out._pointer.mirrored)})
        return made


# Fields of objects that others were made from.
_ORIGINS = ("mesh", "layout", "target")


class Kept(Handle):
    """An object that can be kept: `save` and `load` write and read a file, `to_bytes` and `from_bytes` the same in memory.

    What is read is as it was, bit for bit, and nothing is solved again. Equal objects are equal bytes, whatever the number of threads;
    seconds are not kept. `pickle`, joblib and the like keep the same bytes.
    """

    # True for a map whose source is a mirror image.
    _mirror: bool = False

    def to_bytes(self, progress: Progress = None) -> bytes:
        """The object as bytes.

        Parameters
        ----------
        progress : Progress
            a `Control` or a callback.
        """
        return Archive.of(self._type, self._pointer, self._mirror, progress).bytes()

    @classmethod
    def from_bytes(cls, data: bytes | bytearray | memoryview, progress: Progress = None) -> Self:
        """The object of `to_bytes`.

        Parameters
        ----------
        data : bytes | bytearray | memoryview
            the bytes.
        progress : Progress
            a `Control` or a callback.

        Raises
        ------
        ParseError
            bytes that are cut off or damaged.
        FileError
            of another format, or of another version of it.
        ArgumentError
            of an object of another class; the message names it.
        """
        return cls._checked(Archive.parse(data).object(progress))

    def save(self, path: str | os.PathLike[str], progress: Progress = None) -> None:
        """Write the object to a file, whole or not at all, which `load`, the library in C and the crate in Rust read.

        Parameters
        ----------
        path : str | os.PathLike[str]
            the file, with any extension.
        progress : Progress
            a `Control` or a callback.
        """
        Archive.of(self._type, self._pointer, self._mirror, progress).write(path)

    @classmethod
    def load(cls, path: str | os.PathLike[str], progress: Progress = None) -> Self:
        """The object of a file that `save` wrote.

        Parameters
        ----------
        path : str | os.PathLike[str]
            the file.
        progress : Progress
            a `Control` or a callback.

        Raises
        ------
        FileError
            a file that is not there, of another format, or of another version of it.
        ParseError
            a file that is cut off or damaged.
        ArgumentError
            a file with an object of another class; the message names it.
        """
        return cls._checked(Archive.read(path).object(progress))

    @classmethod
    def _checked(cls, made: Any) -> Self:
        if not isinstance(made, cls):
            raise ArgumentError(f"this is the archive of a {type(made).__name__}, not of a {cls.__name__}")
        return made

    def _come_from(self, found: Mapping[str, Any]) -> None:
        """Take over what this object was made from: `mesh`, `target`, `layout`, and whether it is `mirrored`."""

    def __reduce__(self) -> Any:
        """The bytes of the object."""
        return _restored, (self.to_bytes(),)


def _restored(data: bytes) -> Any:
    """The object of a pickle."""
    return Archive.parse(data).object()


def load(path: str | os.PathLike[str], progress: Progress = None) -> Any:
    """The object of a file that `save` of any class wrote: an instance of that class.

    Parameters
    ----------
    path : str | os.PathLike[str]
        the file.
    progress : Progress
        a `Control` or a callback.

    Raises
    ------
    FileError
        a file that is not there, of another format, or of another version of it.
    ParseError
        a file that is cut off or damaged.

    Examples
    --------
    >>> ricci.flow(ricci.make("torus", n=8)).save("flat.ricci")
    >>> ricci.layout(ricci.load("flat.ricci")).summary.n_flipped
    0
    """
    return Archive.read(path).object(progress)
